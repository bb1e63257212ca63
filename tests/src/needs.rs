//! Requirements of some tests in addition to a Rust toolchain. A test without them is left out,
//! with a message, or fails if they must be met.
//!
//! `BACKCAST_REQUIRE` names the requirements that must be met: a list of [`Need::name`], `all` or
//! `none`. If it is not set but `CI` is, all but overlay, root and data must be met. Each test that
//! was left out adds a line to `target/left-out.txt`, which `.ci/run` counts at its end.

use std::fs::OpenOptions;
use std::io::Write;

use transport::testing::OwnFileSystem;

use crate::executables;

/// Something that a test needs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Need {
    /// Chromium and its driver.
    Browser,
    /// Python 3 and the package registry.
    Python,
    /// npm and its package registry.
    Npm,
    /// A kernel that lets this user make namespaces, for networks or mounts.
    Namespaces,
    /// A kernel that can mount an overlay on the root file system.
    Overlay,
    /// A superuser, who can act as other users.
    Root,
    /// The recordings of other robots, next to the project.
    Data,
}

impl Need {
    /// Returns its name in `BACKCAST_REQUIRE`.
    pub fn name(self) -> String {
        format!("{self:?}").to_lowercase()
    }

    fn is_required(self, list: Option<&str>, in_ci: bool) -> bool {
        match list {
            Some(list) => {
                let mut names = list.split(',').map(str::trim);
                names.any(|name| name == self.name() || name == "all")
            }
            None => in_ci && ![Need::Overlay, Need::Root, Need::Data].contains(&self),
        }
    }

    /// Reports that a test is left out because this is missing.
    pub fn is_missing(self, test: &str, why: &str) {
        let list = std::env::var("BACKCAST_REQUIRE").ok();
        let in_ci = std::env::var_os("CI").is_some_and(|value| !value.is_empty());
        let name = self.name();
        assert!(
            !self.is_required(list.as_deref(), in_ci),
            "{test} needs {name}, which must be there (BACKCAST_REQUIRE={}): {why}",
            list.as_deref().unwrap_or("not set, in CI")
        );
        eprintln!("left out: {test} needs {name}: {why}");
        let mut file = OpenOptions::new()
            .create(true)
            .append(true)
            .open(executables::target().join("left-out.txt"))
            .unwrap();
        let why = why.lines().next().unwrap_or_default();
        writeln!(file, "{test}: {name}: {why}").unwrap();
    }
}

/// True if the calling test, named `test`, runs where the file system at `path` is its own, of this
/// size. Otherwise it has already been run there, or the kernel forbids that, which is reported.
pub fn has_its_own(test: &str, path: &str, size: &str) -> bool {
    // The executables are built in advance, where there is room.
    let _ = executables::path("backcast");
    let place = OwnFileSystem::of_test(test, path, size);
    if place == OwnFileSystem::Forbidden {
        Need::Namespaces.is_missing(test, "this kernel lets this user mount nothing");
    }
    place == OwnFileSystem::Here
}
