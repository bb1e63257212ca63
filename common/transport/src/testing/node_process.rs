//! A node as a process in a test's graph.

use std::ffi::OsStr;
use std::io::Read;
use std::process::{Child, ChildStderr, Command, ExitStatus, Stdio};
use std::thread::JoinHandle;

use nix::sys::signal::{Signal, kill};
use nix::unistd::Pid;

use crate::node::LOG_FORMAT_VARIABLE;
use crate::{GRAPH_VARIABLE, Graph};

/// A node in a process, killed if the test fails before it has ended; its log is printed then.
#[derive(Debug)]
pub struct NodeProcess {
    child: Child,
    /// Thread that reads the log all the time, as a full pipe would block the node.
    log: Option<JoinHandle<Vec<u8>>>,
}

impl NodeProcess {
    /// Starts `executable`, as of `env!("CARGO_BIN_EXE_…")`, in `graph` with default logging.
    pub fn start<A: AsRef<OsStr>>(
        executable: &str,
        graph: &Graph,
        arguments: impl IntoIterator<Item = A>,
    ) -> Self {
        let mut child = Command::new(executable)
            .args(arguments)
            .env(GRAPH_VARIABLE, graph.name().as_str())
            .env_remove("RUST_LOG")
            .env_remove(LOG_FORMAT_VARIABLE)
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        let pipe = child.stderr.take().unwrap();
        let log = Some(std::thread::spawn(move || read_all(pipe)));
        NodeProcess { child, log }
    }

    pub fn pid(&self) -> Pid {
        Pid::from_raw(self.child.id().cast_signed())
    }

    pub fn interrupt(&self) {
        kill(self.pid(), Signal::SIGTERM).unwrap();
    }

    /// Waits until the process ends; returns its exit status and log.
    pub fn finish(mut self) -> (ExitStatus, String) {
        let status = self.child.wait().unwrap();
        let log = String::from_utf8(self.take_log()).unwrap();
        (status, log)
    }

    /// Like [`NodeProcess::finish`], but returns only the exit code; `None` if a signal ended it.
    pub fn exit_code(self) -> Option<i32> {
        self.finish().0.code()
    }

    /// Sends SIGTERM and waits until the process ends with success.
    pub fn stop(self) {
        self.stop_with_log();
    }

    /// Like [`NodeProcess::stop`], but returns the log.
    pub fn stop_with_log(self) -> String {
        self.interrupt();
        let (status, log) = self.finish();
        assert!(status.success(), "{status}\n{log}");
        log
    }

    pub fn kill(mut self) {
        self.child.kill().unwrap();
        self.child.wait().unwrap();
        self.take_log();
    }

    fn take_log(&mut self) -> Vec<u8> {
        let log = self.log.take();
        log.map_or_else(Vec::new, |log| log.join().unwrap())
    }
}

impl Drop for NodeProcess {
    fn drop(&mut self) {
        if self.log.is_none() {
            // It has ended already.
            return;
        }
        let _ = self.child.kill();
        let _ = self.child.wait();
        let log = self.take_log();
        if std::thread::panicking() {
            eprintln!("the node logged:\n{}", String::from_utf8_lossy(&log));
        }
    }
}

/// A node that must end with success when its test has passed.
#[derive(Debug)]
pub struct StoppedAtEnd(Option<NodeProcess>);

impl From<NodeProcess> for StoppedAtEnd {
    fn from(node: NodeProcess) -> Self {
        StoppedAtEnd(Some(node))
    }
}

impl Drop for StoppedAtEnd {
    fn drop(&mut self) {
        if let Some(node) = self.0.take()
            && !std::thread::panicking()
        {
            node.stop();
        }
    }
}

fn read_all(mut pipe: ChildStderr) -> Vec<u8> {
    let mut log = Vec::new();
    pipe.read_to_end(&mut log).unwrap();
    log
}
