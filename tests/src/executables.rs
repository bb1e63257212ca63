//! The node executables, built by the tests that start them: a test run builds
//! those of its own crate alone.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::OnceLock;

/// Everything that the graphs of the tests need, in the groups in which
/// `cargo run` and the descriptor build it: cargo would build what they depend
/// on anew for another group.
const GROUPS: [&[&str]; 2] = [
    &[
        "replayer",
        "map_server",
        "boundary_extractor",
        "accumulator",
        "peak_extractor",
        "monitor",
        "recorder",
        "emulator",
        "lms_reader",
    ],
    &["backcast"],
];

/// The path of an executable, built in the profile of the tests.
#[must_use]
pub fn path(name: &str) -> PathBuf {
    static BUILT: [OnceLock<()>; GROUPS.len()] = [const { OnceLock::new() }; GROUPS.len()];
    // The tests lie in `<target>/<profile>/deps`, executables one above.
    let test = std::env::current_exe().unwrap();
    let folder = test.ancestors().nth(2).unwrap();
    let group = GROUPS.iter().position(|group| group.contains(&name));
    let group = group.unwrap_or_else(|| panic!("{name} is in no group"));
    BUILT[group].get_or_init(|| build_group(GROUPS[group], folder));
    folder.join(name)
}

fn build_group(packages: &[&str], folder: &Path) {
    // While a graph is joined, iceoryx2 changes the mask of the whole process;
    // what cargo makes would not be executable.
    let mut command = Command::new("sh");
    command.args(["-c", "umask 022 && exec \"$0\" \"$@\"", env!("CARGO")]);
    command.current_dir(crate::root());
    command.args(["build", "--quiet", "--locked"]);
    command.arg("--target-dir").arg(folder.parent().unwrap());
    if folder.ends_with("release") {
        command.arg("--release");
    }
    for package in packages {
        command.args(["--package", package]);
    }
    let status = command.status().unwrap();
    assert!(status.success(), "{packages:?} do not build");
}
