//! The launcher as a child process, started as by a user, and its output.

use std::io::{self, BufRead, BufReader};
use std::os::unix::process::CommandExt;
use std::process::{Child, Command, ExitStatus, Stdio};
use std::sync::mpsc::{Receiver, channel};
use std::thread;

use geometry::Pose;
use nix::sys::signal::{Signal, kill};
use nix::unistd::Pid;
use serde::{Deserialize, Serialize};

#[derive(Debug, Deserialize)]
pub(super) struct Printed {
    /// Pose of the tracker; `None` if there is none for the scan.
    #[serde(default)]
    pub(super) pose: Option<SentPose>,
    /// Only in the last line.
    #[serde(default)]
    pub(super) summary: Option<Losses>,
}

#[derive(Debug, Clone, Deserialize)]
pub(super) struct SentPose {
    /// Stamp of the scan, in nanoseconds since 1970.
    pub(super) stamp_ns: i64,
    pub(super) state: String,
    /// Pose of the laser in the map, if known.
    pub(super) laser: Option<Pose>,
    pub(super) latency_ms: f64,
    /// By the machine's monotonic clock.
    pub(super) sent_ns: i64,
}

#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Deserialize, Serialize)]
pub(super) struct Losses {
    pub(super) scans: u64,
    pub(super) answered: u64,
    pub(super) dropped: u64,
    pub(super) refused: u64,
}

impl SentPose {
    /// Time at which the scan entered the graph, by the machine's monotonic clock.
    pub(super) fn entered_ns(&self) -> i64 {
        self.sent_ns - (self.latency_ms * 1e6) as i64
    }
}

#[derive(Debug)]
pub(super) struct Launched {
    child: Child,
    lines: Receiver<Printed>,
}

impl Launched {
    /// Starts the launcher next to this executable with `run` and the arguments.
    pub(super) fn start(arguments: &[String]) -> anyhow::Result<Self> {
        let own = std::env::current_exe().map_err(not_started)?;
        let mut child = Command::new(own.with_file_name("backcast"))
            .arg("run")
            .args(arguments)
            .stdin(Stdio::null())
            .stdout(Stdio::piped())
            // Ctrl-C goes to this process, which stops the launcher in order.
            .process_group(0)
            .spawn()
            .map_err(not_started)?;
        let (send, lines) = channel();
        let stdout = child.stdout.take();
        let read = move || {
            let lines = stdout
                .into_iter()
                .flat_map(|out| BufReader::new(out).lines());
            for line in lines.map_while(Result::ok) {
                // Other versions may print lines that this one cannot parse.
                if let Ok(printed) = serde_json::from_str(&line)
                    && send.send(printed).is_err()
                {
                    return;
                }
            }
        };
        let thread = thread::Builder::new().name("rows".into());
        thread.spawn(read).map_err(not_started)?;
        Ok(Launched { child, lines })
    }

    /// Lines of output; disconnected at the end of the output.
    pub(super) fn lines(&self) -> &Receiver<Printed> {
        &self.lines
    }

    pub(super) fn pid(&self) -> i32 {
        self.child.id().cast_signed()
    }

    pub(super) fn ask_to_stop(&self) -> anyhow::Result<()> {
        signal(self.pid(), Signal::SIGINT)
    }

    pub(super) fn wait(&mut self) -> anyhow::Result<ExitStatus> {
        self.child.wait().map_err(not_started)
    }

    pub(super) fn kill(&mut self) -> anyhow::Result<()> {
        self.child.kill().map_err(not_started)?;
        self.wait().map(drop)
    }
}

impl Drop for Launched {
    fn drop(&mut self) {
        // After an error; the launcher's nodes end with it.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// Signals a process. A process that has ended is no error.
pub(super) fn signal(pid: i32, signal: Signal) -> anyhow::Result<()> {
    match kill(Pid::from_raw(pid), signal) {
        Ok(()) | Err(nix::errno::Errno::ESRCH) => Ok(()),
        Err(errno) => Err(not_started(errno.into())),
    }
}

fn not_started(source: io::Error) -> anyhow::Error {
    let text = "cannot start, signal or wait for the processes of the graph";
    anyhow::Error::new(source).context(text)
}
