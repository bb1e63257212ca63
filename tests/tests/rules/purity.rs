//! Pure crates: they link little, and use nothing outside their arguments.

use std::collections::BTreeSet;

use syn::visit::Visit;
use syn::{ItemUse, UseTree};

use crate::workspace::{files, known};

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

impl Paths {
    fn import(&mut self, before: &str, tree: &UseTree) {
        let below = |name: &dyn std::fmt::Display| match before {
            "" => name.to_string(),
            _ => format!("{before}::{name}"),
        };
        match tree {
            UseTree::Path(path) => self.import(&below(&path.ident), &path.tree),
            UseTree::Name(name) => _ = self.0.insert(below(&name.ident)),
            UseTree::Rename(name) => _ = self.0.insert(below(&name.ident)),
            UseTree::Glob(_) => _ = self.0.insert(below(&"*")),
            UseTree::Group(group) => {
                let trees = group.items.iter();
                trees.for_each(|tree| self.import(before, tree));
            }
        }
    }
}

impl<'ast> Visit<'ast> for Paths {
    fn visit_item_use(&mut self, item: &'ast ItemUse) {
        self.import("", &item.tree);
    }

    fn visit_path(&mut self, path: &'ast syn::Path) {
        let names = path.segments.iter().map(|part| part.ident.to_string());
        self.0.insert(names.collect::<Vec<_>>().join("::"));
        syn::visit::visit_path(self, path);
    }
}

#[test]
fn paths_are_found_however_they_are_written() {
    let source = "use std::{fmt, fs::{self, File}, io as outside};\nfn f() { ::std::env::args(); }";
    let found = paths_in(source);
    let impure: Vec<_> = found.iter().filter(|path| is_impure(path)).collect();
    let expected = [
        "std::env::args",
        "std::fs::File",
        "std::fs::self",
        "std::io",
    ];
    assert_eq!(impure, expected);
    assert!(is_impure("std::*") && !is_impure("std::iter::from_fn"));
    assert!(!is_impure("outside::fs"));
}
