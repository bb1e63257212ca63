//! The node executables, built by the tests that start them: a test run builds only those of its
//! own crate.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::OnceLock;

use transport::Graph;
use transport::testing::{NodeProcess, allow_long};

/// Returns the path of an executable, built in the profile of the tests; `BACKCAST_BUILT` says that
/// all have been built, where each test is a process of its own.
pub fn path(name: &str) -> PathBuf {
    static BUILT: OnceLock<()> = OnceLock::new();
    let folder = folder();
    BUILT.get_or_init(|| match std::env::var_os("BACKCAST_BUILT") {
        Some(_) => {}
        None => allow_long(|| build(&folder)),
    });
    folder.join(name)
}

pub fn start(name: &str, graph: &Graph, arguments: &[&str]) -> NodeProcess {
    NodeProcess::start(path(name).to_str().unwrap(), graph, arguments)
}

/// Returns the folder of the executables: the tests are in `<target>/<profile>/deps`.
fn folder() -> PathBuf {
    let test = std::env::current_exe().unwrap();
    test.ancestors().nth(2).unwrap().to_owned()
}

/// Returns cargo's target folder.
pub(crate) fn target() -> PathBuf {
    folder().with_file_name("")
}

/// Returns the command, with prepared maps cached next to the executables and not in the user's own
/// folder.
pub fn backcast() -> Command {
    let executable = path("backcast");
    let mut command = Command::new(&executable);
    command.env("XDG_CACHE_HOME", executable.with_file_name("test-cache"));
    command
}

/// Builds all executables at once, like `cargo run` and the descriptor: cargo would build their
/// dependencies again for each one.
fn build(folder: &Path) {
    // While a graph is joined, iceoryx2 changes the umask of the whole process; cargo's output
    // would not be executable.
    let mut command = Command::new("sh");
    command.args(["-c", "umask 022 && exec \"$0\" \"$@\"", env!("CARGO")]);
    command.current_dir(crate::root());
    // Build scripts depend on these variables, and cargo passes other values to a test than to
    // build scripts: all of Zenoh would be built again each time.
    for (name, _) in std::env::vars_os() {
        let text = name.to_string_lossy();
        if text.starts_with("CARGO_PKG_") || text.starts_with("CARGO_MANIFEST_") {
            command.env_remove(name);
        }
    }
    command.args(["build", "--quiet", "--locked"]);
    command.arg("--target-dir").arg(folder.parent().unwrap());
    if folder.ends_with("release") {
        command.arg("--release");
    }
    let status = command.status().unwrap();
    assert!(status.success(), "the nodes do not build");
}
