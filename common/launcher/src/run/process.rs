//! One process of a node, in a process group of its own.
//!
//! Signals go to the group, so that what a node starts ends with it. If the
//! launcher dies, in whatever way, the kernel ends the process.

use std::{
    io::{self, IsTerminal},
    os::unix::process::CommandExt,
    path::{Path, PathBuf},
    process::{Child, Command, ExitStatus, Stdio},
    sync::{Arc, Mutex, mpsc::Sender},
};

use dataflow::Node;
use nix::{
    errno::Errno,
    sys::{
        prctl,
        signal::{SigHandler, Signal, killpg, signal},
        wait::{Id, WaitPidFlag, WaitStatus, waitid},
    },
    unistd::{Pid, getpid, getppid},
};
use transport::{GRAPH_VARIABLE, GraphName, node::LOG_FORMAT_VARIABLE};

use super::console;

/// A started process. It must be started on the thread that ends last: the
/// kernel takes the end of that thread for the end of the launcher.
#[derive(Debug)]
pub(crate) struct Process {
    child: Child,
    pid: Pid,
}

/// Where a node's executable is.
pub(crate) fn executable(node: &Node, folder: &Path) -> PathBuf {
    folder.join(&node.path)
}

impl Process {
    /// Starts `node` in `folder` as a member of `graph`. What it says goes to
    /// our standard error, the last line of its own to `last_line`, too; `open` is dropped when
    /// it has said all.
    ///
    /// # Errors
    /// The executable cannot be started.
    pub(crate) fn start(
        node: &Node,
        folder: &Path,
        graph: &GraphName,
        (open, last_line): (&Sender<()>, &Arc<Mutex<String>>),
    ) -> io::Result<Self> {
        let mut command = Command::new(executable(node, folder));
        // Lines on a terminal are short, of nodes too, whose standard error is a pipe.
        if io::stderr().is_terminal() && std::env::var_os(LOG_FORMAT_VARIABLE).is_none() {
            command.env(LOG_FORMAT_VARIABLE, "short");
        }
        command
            .args(&node.args)
            .envs(node.env.iter().map(|(name, value)| (name, value)))
            .env(GRAPH_VARIABLE, graph.as_str())
            .current_dir(folder)
            .stdin(Stdio::null())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .process_group(0);
        prepare_signals(&mut command);
        let mut child = command.spawn()?;
        let pid = i32::try_from(child.id()).map_err(io::Error::other)?;
        let (stdout, stderr) = (child.stdout.take(), child.stderr.take());
        // From here on the process is owned: whatever fails, it is ended.
        let process = Process {
            child,
            pid: Pid::from_raw(pid),
        };
        if let Some(stream) = stdout {
            console::forward(&node.id, stream, open.clone(), |_| {})?;
        }
        if let Some(stream) = stderr {
            let last_line = Arc::clone(last_line);
            let keep = move |line: &str| {
                // The address of a page with its token is for the console alone.
                if !line.contains("#token=")
                    && let Ok(mut last_line) = last_line.lock()
                {
                    line.clone_into(&mut last_line);
                }
            };
            console::forward(&node.id, stream, open.clone(), keep)?;
        }
        Ok(process)
    }

    /// Its number.
    pub(crate) fn pid(&self) -> i32 {
        self.pid.as_raw()
    }

    /// How it ended, if it did; then what it has started is ended too.
    ///
    /// # Errors
    /// The process is not ours to wait for.
    pub(crate) fn poll(&mut self) -> io::Result<Option<ExitStatus>> {
        // While it is not waited for, its number cannot come to mean another
        // process, so the group is still its group.
        let flags = WaitPidFlag::WEXITED | WaitPidFlag::WNOHANG | WaitPidFlag::WNOWAIT;
        if waitid(Id::Pid(self.pid), flags)? == WaitStatus::StillAlive {
            return Ok(None);
        }
        self.signal(Signal::SIGKILL)?;
        self.child.wait().map(Some)
    }

    /// Sends `signal` to the whole group.
    ///
    /// # Errors
    /// The group is not ours.
    pub(crate) fn signal(&self, signal: Signal) -> io::Result<()> {
        match killpg(self.pid, signal) {
            // All of it has ended.
            Err(Errno::ESRCH) => Ok(()),
            other => Ok(other?),
        }
    }

    /// Ends the group at once and waits for the process.
    ///
    /// # Errors
    /// As [`Process::signal`] and [`Process::poll`].
    pub(crate) fn kill(&mut self) -> io::Result<()> {
        self.signal(Signal::SIGKILL)?;
        self.child.wait().map(drop)
    }
}

impl Drop for Process {
    /// Nothing that was started stays behind, whatever failed.
    fn drop(&mut self) {
        // A process that was waited for is known to its handle, and its number
        // may be another's by now.
        if matches!(self.child.try_wait(), Ok(None)) {
            let _ = self.kill();
        }
    }
}

/// Asks for SIGTERM when we die; and SIGUSR1, which we pass on, does no harm before
/// the program that is started has said what it means.
fn prepare_signals(command: &mut Command) {
    let parent = getpid();
    let ask = move || {
        prctl::set_pdeathsig(Signal::SIGTERM)?;
        // SAFETY: to ignore a signal calls nothing.
        unsafe { signal(Signal::SIGUSR1, SigHandler::SigIgn) }?;
        // A parent that died before the request is not signalled.
        if getppid() != parent {
            return Err(Errno::ESRCH.into());
        }
        Ok(())
    };
    // SAFETY: between fork and exec only system calls are made; nothing is
    // allocated and no lock is taken.
    unsafe { command.pre_exec(ask) };
}
