//! The launcher as a process, with small shell scripts as nodes.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod graphs;
mod processes;
mod usage;

use std::fs::{self, File};
use std::io::{BufRead, BufReader, Lines, Read};
use std::os::unix::net::UnixDatagram;
use std::os::unix::process::{CommandExt, ExitStatusExt};
use std::path::Path;
use std::process::{Child, ChildStderr, Command, ExitStatus, Stdio};

use messages::{NodeState, topic};
use nix::sys::signal::{Signal, kill};
use nix::sys::stat::Mode;
use nix::unistd::{Pid, mkfifo};
use tempfile::TempDir;
use tests::needs::Need;
use tests::{assert_ends, said_by};
use transport::testing::wait_until;
use transport::{Graph, GraphName};

fn graph(nodes: &[&str]) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    let nodes: String = nodes
        .iter()
        .map(|n| format!("  - {{path: /bin/sh, {n}}}\n"))
        .collect();
    let text = format!("nodes:\n{nodes}");
    fs::write(folder.path().join("dataflow.yaml"), text).unwrap();
    folder
}

/// Creates a graph whose source says `up` and ends after [`let_go`].
fn waiting_graph() -> TempDir {
    let folder = graph(&["id: source, outputs: [scan], args: -c 'echo up; read line < pipe'"]);
    mkfifo(&folder.path().join("pipe"), Mode::S_IRWXU).unwrap();
    folder
}

fn let_go(folder: &TempDir) {
    fs::write(folder.path().join("pipe"), "\n").unwrap();
}

fn launcher(folder: &Path, args: &[&str]) -> Command {
    // Under nohup, hangups are ignored, and the launcher would keep that setting.
    let mut command = Command::new("env");
    command
        .args(["--default-signal=HUP", env!("CARGO_BIN_EXE_backcast")])
        .args(args)
        .current_dir(folder)
        .env_remove("BACKCAST_GRAPH")
        .env_remove("RUST_LOG")
        .stdin(Stdio::null())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped());
    command
}

fn run(nodes: &[&str], args: &[&str]) -> (i32, String, String) {
    said_by(&mut launcher(graph(nodes).path(), args))
}

struct Running {
    child: Child,
    said: Lines<BufReader<ChildStderr>>,
}

impl Running {
    fn start(folder: &TempDir, args: &[&str]) -> Self {
        let mut child = launcher(folder.path(), args).spawn().unwrap();
        let said = BufReader::new(child.stderr.take().unwrap()).lines();
        Running { child, said }
    }

    /// Starts a graph of this name and waits until its source says `up`.
    fn start_and_wait(folder: &TempDir, name: &str) -> Self {
        let mut running = Running::start(folder, &["--graph", name]);
        assert_eq!(running.receive("source"), "up");
        running
    }

    fn receive(&mut self, node: &str) -> String {
        let mark = format!("{node} | ");
        let mut all = self.said.by_ref().map(Result::unwrap);
        let received =
            all.find_map(|line| line.trim_start().strip_prefix(&mark).map(ToOwned::to_owned));
        received.unwrap_or_else(|| panic!("{node} said nothing more"))
    }

    fn signal(&self, signal: Signal) {
        let pid = i32::try_from(self.child.id()).unwrap();
        kill(Pid::from_raw(pid), signal).unwrap();
    }

    fn end_well(self) {
        let (status, said) = self.wait();
        assert_eq!(status.code(), Some(0), "{said}");
    }

    fn wait(mut self) -> (ExitStatus, String) {
        // Reads the pipe to its end, so that the process does not block on it.
        let said: Vec<String> = self.said.by_ref().map(Result::unwrap).collect();
        (self.child.wait().unwrap(), said.join("\n"))
    }
}

/// Returns true if a process has ended, or is a zombie that no process reaps.
fn has_ended(pid: &str) -> bool {
    fs::read_to_string(format!("/proc/{pid}/stat")).map_or(true, |stat| stat.contains(") Z "))
}

fn shared_memory_of(graph: &str) -> Vec<String> {
    fs::read_dir("/dev/shm")
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .filter(|name| name.contains(graph))
        .collect()
}
