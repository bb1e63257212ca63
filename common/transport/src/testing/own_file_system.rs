//! Runs a test with a file system of its own, which it can fill without disturbing other processes.

use std::process::{Command, Stdio};

use nix::unistd::geteuid;

const INSIDE: &str = "BACKCAST_TEST_INSIDE";

/// Place where a test with a file system of its own runs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum OwnFileSystem {
    /// In this process, which has its own file system.
    Here,
    /// In another process, where it has passed.
    Elsewhere,
    /// Nowhere: the kernel does not allow this user to mount.
    Forbidden,
}

impl OwnFileSystem {
    /// Gives the calling test, named `test`, a file system at `path` of this size, e.g. `16m`.
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
