//! The launcher as a child process, as a user starts it, and what it prints.

use std::io::{self, BufRead, BufReader};
use std::os::unix::process::CommandExt;
use std::path::Path;
use std::process::{Child, Command, ExitStatus, Stdio};
use std::sync::mpsc::{Receiver, channel};
use std::thread;

use geometry::Pose;
use nix::sys::signal::{Signal, kill};
use nix::unistd::Pid;
use serde::Deserialize;

use crate::SoakError;

/// A line that it prints.
#[derive(Debug, Deserialize)]
pub(super) struct Printed {
    /// Where the tracker has the robot; none where it said nothing of the scan.
    #[serde(default)]
    pub(super) pose: Option<SentPose>,
    /// In the last line alone.
    #[serde(default)]
    pub(super) summary: Option<Losses>,
}

/// A pose, as far as it matters here.
#[derive(Debug, Clone, Deserialize)]
pub(super) struct SentPose {
    /// Of the scan, nanoseconds since 1970.
    pub(super) stamp_ns: i64,
    pub(super) state: String,
    pub(super) x: Option<f64>,
    pub(super) y: Option<f64>,
    pub(super) heading_deg: Option<f64>,
    pub(super) latency_ms: f64,
    /// On the machine's monotonic clock.
    pub(super) sent_ns: i64,
}

/// Counts of the summary.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Deserialize, serde::Serialize)]
pub(super) struct Losses {
    pub(super) scans: u64,
    pub(super) answered: u64,
    pub(super) dropped: u64,
    pub(super) refused: u64,
}

impl SentPose {
    /// Of the laser in the map, where it is known.
    pub(super) fn pose(&self) -> Option<Pose> {
        Some(Pose::new(self.x?, self.y?, self.heading_deg?.to_radians()))
    }

    /// When its scan entered the graph, on the machine's monotonic clock.
    pub(super) fn entered_ns(&self) -> i64 {
        self.sent_ns - (self.latency_ms * 1e6) as i64
    }
}

/// A launcher that runs.
#[derive(Debug)]
pub(super) struct Launched {
    child: Child,
    lines: Receiver<Printed>,
}

impl Launched {
    /// Starts this executable with `arguments` after `run`.
    ///
    /// # Errors
    /// It cannot be started.
    pub(super) fn start(arguments: &[String]) -> Result<Self, SoakError> {
        let executable = std::env::current_exe().map_err(not_started)?;
        Self::start_program(&executable, arguments)
    }

    fn start_program(executable: &Path, arguments: &[String]) -> Result<Self, SoakError> {
        let mut child = Command::new(executable)
            .arg("run")
            .args(arguments)
            .stdin(Stdio::null())
            .stdout(Stdio::piped())
            // Ctrl-C is for us, who stop it in order.
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
                // Lines of a later version may hold what this one does not know.
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

    /// What it prints; the end where it prints no more.
    pub(super) fn lines(&self) -> &Receiver<Printed> {
        &self.lines
    }

    /// Its number.
    pub(super) fn pid(&self) -> i32 {
        self.child.id().cast_signed()
    }

    /// Asks it to stop in order.
    ///
    /// # Errors
    /// It cannot be signalled.
    pub(super) fn ask_to_stop(&self) -> Result<(), SoakError> {
        signal(self.pid(), Signal::SIGINT)
    }

    /// Waits for its end.
    ///
    /// # Errors
    /// It is not ours to wait for.
    pub(super) fn wait(&mut self) -> Result<ExitStatus, SoakError> {
        self.child.wait().map_err(not_started)
    }

    /// Ends it at once.
    ///
    /// # Errors
    /// It is not ours to wait for.
    pub(super) fn kill(&mut self) -> Result<(), SoakError> {
        self.child.kill().map_err(not_started)?;
        self.wait().map(drop)
    }
}

impl Drop for Launched {
    fn drop(&mut self) {
        // Where something failed; its nodes follow it.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// Signals a process. One that has ended meanwhile is nothing to wonder at.
///
/// # Errors
/// It is not ours.
pub(super) fn signal(pid: i32, signal: Signal) -> Result<(), SoakError> {
    match kill(Pid::from_raw(pid), signal) {
        Ok(()) | Err(nix::errno::Errno::ESRCH) => Ok(()),
        Err(errno) => Err(not_started(errno.into())),
    }
}

fn not_started(source: io::Error) -> SoakError {
    SoakError::NotLaunched(source)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn poses_and_the_summary_are_read_from_what_run_prints() {
        let row = r#"{"verdict":"Unique","pose":{"stamp_ns":5,"state":"Unique","x":1.5,"y":-2.0,
            "heading_deg":180.0,"deviation_m":0.1,"latency_ms":2.5,"sent_ns":7000000}}"#;
        let printed: Printed = serde_json::from_str(row).unwrap();
        let pose = printed.pose.unwrap();
        assert_eq!(pose.entered_ns(), 4_500_000);
        assert_eq!(
            pose.pose(),
            Some(Pose::new(1.5, -2.0, std::f64::consts::PI))
        );
        let row = r#"{"stamp_ns":5,"pose":null}"#;
        assert!(serde_json::from_str::<Printed>(row).unwrap().pose.is_none());
        let row = r#"{"summary":{"scans":9,"answered":8,"searched":3,"dropped":1,"refused":0}}"#;
        let summary = serde_json::from_str::<Printed>(row).unwrap().summary;
        let expected = Losses {
            scans: 9,
            answered: 8,
            dropped: 1,
            refused: 0,
        };
        assert_eq!(summary, Some(expected));
    }
}
