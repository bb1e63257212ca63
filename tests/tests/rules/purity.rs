//! Pure crates: they link little, and use nothing outside their arguments.

use std::collections::BTreeSet;

use syn::ItemUse;
use syn::visit::Visit;

use crate::workspace::{files, imports, known, names};

#[test]
fn the_engine_knows_no_process_socket_clock_or_file() {
    let allowed = BTreeSet::from(["geometry", "messages"].map(str::to_owned));
    assert_eq!(known("engine"), allowed);
    is_pure("common/engine/src");
}

#[test]
fn the_codecs_of_lasers_know_no_socket_clock_or_file_and_nothing_of_ours() {
    assert_eq!(known("sick"), BTreeSet::new());
    is_pure("common/sick/src");
}

#[test]
fn the_simulation_knows_no_engine_process_clock_or_file() {
    // The parsers of its options are those of all commands.
    let allowed = BTreeSet::from(["command_line", "geometry", "map"].map(str::to_owned));
    assert_eq!(known("simulation"), allowed);
    is_pure("common/simulation/src");
}

#[test]
fn messages_of_ros_know_no_process_socket_clock_or_file() {
    let allowed = BTreeSet::from(["geometry", "map", "messages"].map(str::to_owned));
    assert_eq!(known("ros"), allowed);
    is_pure("common/ros/src");
}

#[test]
fn what_crosses_a_network_is_read_without_one() {
    assert_eq!(
        known("network_payload"),
        BTreeSet::from(["messages".to_owned()])
    );
    is_pure("common/network_payload/src");
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
