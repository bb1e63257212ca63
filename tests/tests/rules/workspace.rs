//! The workspace, as cargo and the file system report it.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::process::Command;

use serde_json::Value;

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

/// Returns all files below a folder.
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
