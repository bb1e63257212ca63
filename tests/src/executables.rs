//! The node executables, built by the tests that start them: a test run builds
//! those of its own crate alone.

use std::path::PathBuf;
use std::process::Command;
use std::sync::OnceLock;

/// Everything that a graph on a recording needs.
const PACKAGES: [&str; 6] = [
    "accumulator",
    "backcast",
    "boundary_extractor",
    "map_server",
    "peak_extractor",
    "replayer",
];

/// The path of an executable, built in the profile of the tests.
#[must_use]
pub fn path(name: &str) -> PathBuf {
    static FOLDER: OnceLock<PathBuf> = OnceLock::new();
    FOLDER.get_or_init(build).join(name)
}

fn build() -> PathBuf {
    // The tests lie in `<target>/<profile>/deps`, executables one above.
    let test = std::env::current_exe().unwrap();
    let folder = test.ancestors().nth(2).unwrap().to_owned();
    let mut command = Command::new(env!("CARGO"));
    command
        .current_dir(crate::root())
        .args(["build", "--quiet", "--locked"]);
    command.arg("--target-dir").arg(folder.parent().unwrap());
    if folder
        .file_name()
        .is_some_and(|profile| profile == "release")
    {
        command.arg("--release");
    }
    for package in PACKAGES {
        command.args(["--package", package]);
    }
    assert!(
        command.status().unwrap().success(),
        "the nodes do not build"
    );
    folder
}
