//! Pure crates: they link little, and use nothing outside their arguments.

use std::collections::BTreeSet;

use syn::ItemUse;
use syn::visit::Visit;

use crate::workspace::{files, imports, known, names};

/// Pure crates, each with the crates under `common` that it may link. The parsers of the
/// simulation's options are those of all commands.
const PURE: [(&str, &[&str]); 5] = [
    ("engine", &["geometry", "messages"]),
    ("network_payload", &["messages"]),
    ("ros", &["geometry", "map", "messages"]),
    ("sick", &[]),
    ("simulation", &["command_line", "geometry", "map"]),
];

#[test]
fn pure_crates_know_no_process_socket_clock_or_file() {
    for (name, allowed) in PURE {
        let allowed = allowed.iter().map(|other| (*other).to_owned());
        assert_eq!(known(name), allowed.collect(), "{name}");
        is_pure(&format!("common/{name}/src"));
    }
}

/// Modules of the standard library that reach outside a function's arguments.
const IMPURE: [&str; 6] = ["env", "fs", "io", "net", "process", "time"];

fn is_pure(folder: &str) {
    let sources = files(&tests::root().join(folder));
    assert!(!sources.is_empty(), "{folder} has no sources");
    for file in sources {
        let used = paths_in(&std::fs::read_to_string(&file).unwrap());
        let impure: Vec<_> = used.iter().filter(|path| is_impure(path)).collect();
        assert!(impure.is_empty(), "{} uses {impure:?}", file.display());
    }
}

fn is_impure(path: &str) -> bool {
    let module = path.strip_prefix("std::").unwrap_or_default();
    let module = module.split("::").next().unwrap_or_default();
    module == "*" || IMPURE.contains(&module)
}

/// Returns every path in a source, with grouped imports one by one.
fn paths_in(source: &str) -> BTreeSet<String> {
    let mut paths = Paths::default();
    paths.visit_file(&syn::parse_file(source).unwrap());
    paths.0
}

#[derive(Default)]
struct Paths(BTreeSet<String>);

impl<'ast> Visit<'ast> for Paths {
    fn visit_item_use(&mut self, item: &'ast ItemUse) {
        let imports = imports(&[], &item.tree).into_iter();
        self.0
            .extend(imports.map(|(name, path)| match name.as_str() {
                "*" => format!("{}::*", path.join("::")),
                _ => path.join("::"),
            }));
    }

    fn visit_path(&mut self, path: &'ast syn::Path) {
        self.0.insert(names(path).join("::"));
        syn::visit::visit_path(self, path);
    }
}

#[test]
fn paths_are_found_however_they_are_written() {
    let source = "use std::{fmt, fs::{self, File}, io as outside};\nfn f() { ::std::env::args(); }";
    let found = paths_in(source);
    let impure: Vec<_> = found.iter().filter(|path| is_impure(path)).collect();
    let expected = ["std::env::args", "std::fs", "std::fs::File", "std::io"];
    assert_eq!(impure, expected);
    assert!(is_impure("std::*") && !is_impure("std::iter::from_fn"));
    assert!(!is_impure("outside::fs"));
}
