//! The repository's own graph, run by the launcher as a user runs it, while a test disturbs it.

use std::io::{BufRead, BufReader, Lines};
use std::path::PathBuf;
use std::process::{ChildStdout, ExitStatus, Stdio};
use std::thread::JoinHandle;

use nix::sys::signal::{Signal, kill};
use nix::unistd::Pid;
use serde_json::Value;
use tempfile::TempDir;
use transport::GraphName;

use crate::{Killed, executables};

/// A graph that plays a recording in a loop.
pub struct Live {
    /// The nodes end with it.
    launcher: Killed,
    rows: Lines<BufReader<ChildStdout>>,
    log: JoinHandle<Vec<String>>,
    _folder: TempDir,
}

/// Returns the repository's descriptor with the executables of this test run; `more` is inserted
/// into each node that is restarted, each line indented by four.
pub fn descriptor(more: &str) -> String {
    let text = std::fs::read_to_string(crate::root().join("dataflow.yaml")).unwrap();
    let folder = executables::path("backcast").with_file_name("");
    let root = crate::root().canonicalize().unwrap();
    let lines = text
        .lines()
        .filter(|line| !line.trim().starts_with("build:"));
    let text: String = lines.map(|line| format!("{line}\n")).collect();
    text.replace("target/release/", &folder.display().to_string())
        .replace(" recordings/", &format!(" {}/recordings/", root.display()))
        .replace(
            "    restart_policy: on-failure\n",
            &format!("    restart_policy: on-failure\n{more}"),
        )
}

impl Live {
    /// Starts the graph `name`.
    pub fn start(name: &str, more: &str) -> Self {
        Self::start_with(name, more, &[])
    }

    /// Starts the graph `name` with further options of `backcast run`.
    pub fn start_with(name: &str, more: &str, options: &[&str]) -> Self {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("dataflow.yaml");
        std::fs::write(&file, descriptor(more)).unwrap();
        let recording = crate::root().join("recordings/malaga_corridor/recording.mcap");
        let mut launcher = executables::backcast();
        launcher.arg("run").arg(&file).args(["--graph", name]);
        launcher.args(options);
        launcher.args(["--json", "--loop", "--no-monitor", "--replay"]);
        let mut launcher = launcher
            .arg(recording)
            .env_remove("RUST_LOG")
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        let rows = BufReader::new(launcher.stdout.take().unwrap()).lines();
        let said = BufReader::new(launcher.stderr.take().unwrap()).lines();
        let log = std::thread::spawn(move || said.map_while(Result::ok).collect());
        Live {
            launcher: Killed(launcher),
            rows,
            log,
            _folder: folder,
        }
    }

    /// Waits for the pose of a scan, in any state.
    pub fn pose(&mut self) -> Value {
        loop {
            let row = self.rows.next().expect("the graph goes on").unwrap();
            let mut row: Value = serde_json::from_str(&row).unwrap();
            assert!(row["summary"].is_null(), "the graph ended: {row}");
            if !row["pose"].is_null() {
                return row["pose"].take();
            }
        }
    }

    /// Waits for `count` poses; returns the times of their scans, nanoseconds.
    pub fn poses(&mut self, count: usize) -> Vec<i64> {
        let measured = |_| self.pose()["stamp_ns"].as_i64().unwrap();
        (0..count).map(measured).collect()
    }

    /// Process id of the launcher.
    pub fn launcher(&self) -> Pid {
        Pid::from_raw(self.launcher.0.id().cast_signed())
    }

    /// Returns the processes that the launcher has started, by executable.
    pub fn nodes(&self) -> Vec<(String, Pid)> {
        let pid = self.launcher();
        let path = format!("/proc/{pid}/task/{pid}/children");
        let children = std::fs::read_to_string(path).unwrap();
        let node = |pid: &str| {
            let name = std::fs::read_link(format!("/proc/{pid}/exe")).ok()?;
            let name = name.file_name()?.to_str()?.to_owned();
            Some((name, Pid::from_raw(pid.parse().ok()?)))
        };
        children.split_whitespace().filter_map(node).collect()
    }

    /// Waits for a process of this executable and returns it.
    pub fn node(&self, executable: &str) -> Pid {
        loop {
            let nodes = self.nodes();
            if let Some((_, pid)) = nodes.iter().find(|(name, _)| name == executable) {
                return *pid;
            }
            std::thread::yield_now();
        }
    }

    /// Stops the graph in order; returns exit status, summary and log.
    pub fn stop(mut self) -> (ExitStatus, Value, Vec<String>) {
        kill(self.launcher(), Signal::SIGINT).unwrap();
        let rows = self.rows.by_ref().map(Result::unwrap);
        let last = rows.last().expect("a summary");
        let mut last: Value = serde_json::from_str(&last).unwrap();
        let said = self.log.join().unwrap();
        let status = self.launcher.0.wait().unwrap();
        (status, last["summary"].take(), said)
    }

    /// Kills the launcher and all nodes at the same time, as if memory ran out.
    pub fn kill_all(mut self) {
        let nodes = self.nodes();
        // They are stopped first, so that none can react to the end of another one.
        for pid in nodes.iter().map(|(_, pid)| *pid) {
            kill(pid, Signal::SIGSTOP).unwrap();
        }
        kill(self.launcher(), Signal::SIGKILL).unwrap();
        for (_, pid) in &nodes {
            kill(*pid, Signal::SIGKILL).unwrap();
        }
        let _ = self.log.join().unwrap();
        self.launcher.0.wait().unwrap();
        // They are no children of ours, and hold their locks until all their threads have ended.
        while !nodes.iter().all(|(_, pid)| has_ended(*pid)) {
            std::thread::yield_now();
        }
    }
}

/// True if no thread of a process runs any more: they are gone, or wait to be reaped.
fn has_ended(pid: Pid) -> bool {
    let Ok(threads) = std::fs::read_dir(format!("/proc/{pid}/task")) else {
        return true;
    };
    threads.flatten().all(|thread| {
        // The state follows the name, which is in brackets.
        let stat = std::fs::read_to_string(thread.path().join("stat"));
        stat.map_or(true, |stat| stat.contains(") Z ") || stat.contains(") X "))
    })
}

/// Lists the files of a graph in shared memory and in this user's temporary folder.
pub fn files_of(name: &str) -> Vec<String> {
    let files = transport::files_of(&GraphName::new(name).unwrap());
    let text = |file: &PathBuf| file.display().to_string();
    files.iter().map(text).collect()
}
