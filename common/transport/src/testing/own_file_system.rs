//! A test where a file system is its own: it can be filled, and nobody else is disturbed.

use std::process::{Command, Stdio};

use nix::unistd::geteuid;

const INSIDE: &str = "BACKCAST_TEST_INSIDE";

/// Where a test runs that needs a file system of its own.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum OwnFileSystem {
    /// Here, it is its own.
    Here,
    /// It was run elsewhere, where it is its own, and has passed.
    Elsewhere,
    /// Nowhere: this kernel lets this user mount nothing.
    Forbidden,
}

impl OwnFileSystem {
    /// For the calling test, which is called `test`, one at `path` of so many bytes, as `16m`.
    ///
    /// # Panics
    /// If the test fails there.
    #[must_use]
    pub fn of_test(test: &str, path: &str, size: &str) -> Self {
        if std::env::var_os(INSIDE).is_some() {
            return OwnFileSystem::Here;
        }
        let mount = format!("mount -t tmpfs -o size={size} tmpfs {path}");
        let user: &[&str] = match geteuid().is_root() {
            true => &["--mount"],
            false => &["--mount", "--user", "--map-root-user"],
        };
        let probe = Command::new("unshare")
            .args(user)
            .args(["sh", "-c", &mount])
            .stderr(Stdio::null())
            .status();
        if !probe.is_ok_and(|status| status.success()) {
            return OwnFileSystem::Forbidden;
        }
        let inner = format!("{mount} && exec \"$0\" {test} --exact --nocapture");
        let status = Command::new("unshare")
            .args(user)
            .args(["sh", "-c", &inner])
            .arg(std::env::current_exe().unwrap())
            .env(INSIDE, "1")
            .status()
            .unwrap();
        assert!(status.success(), "{test} fails in a namespace of its own");
        OwnFileSystem::Elsewhere
    }
}
