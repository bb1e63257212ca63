//! Declared dependencies are used, and library users link few of them.

use std::collections::BTreeSet;
use std::path::Path;

use crate::builds::names;
use crate::workspace::{files, metadata};

#[test]
fn every_dependency_is_used() {
    // This crate has dependencies only for their features.
    const FEATURES: &str = "shared_features";
    let metadata = metadata();
    for package in metadata["packages"].as_array().unwrap() {
        let name = package["name"].as_str().unwrap();
        if name == FEATURES {
            continue;
        }
        let manifest = Path::new(package["manifest_path"].as_str().unwrap());
        let sources = files(manifest.parent().unwrap()).into_iter();
        let sources = sources.filter(|file| file.extension().is_some_and(|ending| ending == "rs"));
        let text: String = sources
            .map(|file| std::fs::read_to_string(file).unwrap())
            .collect();
        let is_name = |c: char| c.is_alphanumeric() || c == '_';
        let words: BTreeSet<&str> = text.split(|c| !is_name(c)).collect();
        for dependency in package["dependencies"].as_array().unwrap() {
            let renamed = dependency["rename"].as_str();
            let dependency = renamed.unwrap_or_else(|| dependency["name"].as_str().unwrap());
            let is_used = words.contains(dependency.replace('-', "_").as_str());
            assert!(
                is_used || dependency == FEATURES || dependency == name,
                "{name} does not use {dependency}"
            );
        }
    }
}

/// Checks the dependencies of a program that uses the engine as a library.
#[test]
fn the_engine_as_a_library_brings_no_command_line_and_no_shared_memory() {
    let names = names(&["--package", "backcast-engine", "--edges", "normal"]);
    let has_all = names.contains("backcast-engine") && names.contains("nalgebra");
    assert!(has_all, "{names:?}");
    let is_foreign = |name: &&String| name.starts_with("clap") || name.starts_with("iceoryx2");
    assert_eq!(names.iter().find(is_foreign), None);
}
