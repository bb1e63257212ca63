//! The workspace, as cargo and the file system report it.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::process::Command;

use serde_json::Value;
use syn::UseTree;

/// Returns cargo's metadata of the workspace.
pub(crate) fn metadata() -> Value {
    let options = ["metadata", "--format-version", "1", "--no-deps", "--locked"];
    let mut command = Command::new(env!("CARGO"));
    tests::json_of(command.args(options).current_dir(tests::root()))
}

/// Returns the workspace's crates, each with the names of the crates it links, without those that
/// only its tests use.
pub(crate) fn dependencies() -> BTreeMap<String, BTreeSet<String>> {
    let metadata = metadata();
    let name = |value: &Value| folder_of(value["name"].as_str().unwrap()).to_owned();
    let linked = |package: &Value| {
        let all = package["dependencies"].as_array().unwrap().iter();
        all.filter(|dependency| dependency["kind"].is_null())
            .map(name)
            .collect()
    };
    let packages = metadata["packages"].as_array().unwrap().iter();
    packages
        .map(|package| (name(package), linked(package)))
        .collect()
}

/// Returns the folder of a package: published packages have a prefix in their names.
pub(crate) fn folder_of(package: &str) -> &str {
    package.strip_prefix("backcast-").unwrap_or(package)
}

pub(crate) fn folders(parent: &str) -> BTreeSet<String> {
    let entries = std::fs::read_dir(tests::root().join(parent)).unwrap();
    entries
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect()
}

pub(crate) fn files(folder: &Path) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).unwrap();
    let paths = entries.map(|entry| entry.unwrap().path());
    paths
        .flat_map(|path| {
            if path.is_dir() {
                files(&path)
            } else {
                vec![path]
            }
        })
        .collect()
}

/// Returns the crates under `common` that this one links.
pub(crate) fn known(name: &str) -> BTreeSet<String> {
    let all = folders("common");
    dependencies()[name].intersection(&all).cloned().collect()
}

/// Returns each import below `before` by its local name, which is `*` for a glob.
pub(crate) fn imports(before: &[String], tree: &UseTree) -> Vec<(String, Vec<String>)> {
    let joined = |name: &syn::Ident| [before, &[name.to_string()]].concat();
    match tree {
        UseTree::Path(path) => imports(&joined(&path.ident), &path.tree),
        UseTree::Name(name) if name.ident == "self" => {
            vec![(before[before.len() - 1].clone(), before.to_vec())]
        }
        UseTree::Name(name) => vec![(name.ident.to_string(), joined(&name.ident))],
        UseTree::Rename(name) => vec![(name.rename.to_string(), joined(&name.ident))],
        UseTree::Glob(_) => vec![("*".to_owned(), before.to_vec())],
        UseTree::Group(group) => {
            let trees = group.items.iter();
            trees.flat_map(|tree| imports(before, tree)).collect()
        }
    }
}

/// Returns the names of a path in an expression or a type.
pub(crate) fn names(path: &syn::Path) -> Vec<String> {
    let names = path.segments.iter().map(|part| part.ident.to_string());
    names.collect()
}
