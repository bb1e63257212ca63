//! The process of a node, in a process group of its own, whose children end with it. If the
//! launcher dies, the kernel ends the process.

use std::io::{self, IsTerminal};
use std::os::unix::process::CommandExt;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitStatus, Stdio};
use std::sync::mpsc::Sender;
use std::sync::{Arc, Mutex};

use dataflow::Node;
use nix::errno::Errno;
use nix::sys::prctl;
use nix::sys::signal::{SigHandler, Signal, killpg, signal};
use nix::sys::wait::{Id, WaitPidFlag, WaitStatus, waitid};
use nix::unistd::{Pid, getpid, getppid};
use transport::{GRAPH_VARIABLE, GraphName, node::LOG_FORMAT_VARIABLE};

use super::console;

/// A started process. It ends with the thread that started it.
#[derive(Debug)]
pub(crate) struct Process {
    child: Child,
    pid: Pid,
}

pub(crate) fn executable(node: &Node, folder: &Path) -> PathBuf {
    folder.join(&node.path)
}

pub(crate) fn not_started(node: &Node, folder: &Path) -> String {
    let (id, path) = (&node.id, executable(node, folder));
    let (path, folder) = (path.display(), folder.display());
    format!("node {id}: {path} cannot be started in {folder}")
}

impl Process {
    /// Starts `node` in `folder` as a member of `graph`; `open` is dropped when both its streams
    /// have ended.
    pub(crate) fn start(
        node: &Node,
        folder: &Path,
        graph: &GraphName,
        (open, last_line): (&Sender<()>, &Arc<Mutex<String>>),
    ) -> io::Result<Self> {
        let mut command = Command::new(executable(node, folder));
        // On a terminal, log lines are short; nodes cannot tell, as their standard error is a pipe.
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
        // From here on, `Drop` ends the process on any error.
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
                // An address with a token must only appear on the console.
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

    pub(crate) fn pid(&self) -> i32 {
        self.pid.as_raw()
    }

    /// Returns the exit status if the process has ended; then its whole group is killed.
    pub(crate) fn poll(&mut self) -> io::Result<Option<ExitStatus>> {
        // Until the process is waited for, its id is not reused, so the group is still its group.
        let flags = WaitPidFlag::WEXITED | WaitPidFlag::WNOHANG | WaitPidFlag::WNOWAIT;
        if waitid(Id::Pid(self.pid), flags)? == WaitStatus::StillAlive {
            return Ok(None);
        }
        self.signal(Signal::SIGKILL)?;
        self.child.wait().map(Some)
    }

    pub(crate) fn signal(&self, signal: Signal) -> io::Result<()> {
        match killpg(self.pid, signal) {
            // All processes of the group have ended.
            Err(Errno::ESRCH) => Ok(()),
            other => Ok(other?),
        }
    }

    pub(crate) fn kill(&mut self) -> io::Result<()> {
        self.signal(Signal::SIGKILL)?;
        self.child.wait().map(drop)
    }
}

impl Drop for Process {
    fn drop(&mut self) {
        // A process that was waited for is known to its handle; its id may be reused by now.
        if matches!(self.child.try_wait(), Ok(None)) {
            let _ = self.kill();
        }
    }
}

/// Requests SIGTERM for the child when we die; it ignores SIGUSR1 until it sets a handler.
fn prepare_signals(command: &mut Command) {
    let parent = getpid();
    let ask = move || {
        prctl::set_pdeathsig(Signal::SIGTERM)?;
        // SAFETY: ignoring a signal installs no handler.
        unsafe { signal(Signal::SIGUSR1, SigHandler::SigIgn) }?;
        // If the parent died before the request, no signal comes.
        if getppid() != parent {
            return Err(Errno::ESRCH.into());
        }
        Ok(())
    };
    // SAFETY: between fork and exec only system calls are made; nothing is
    // allocated and no lock is taken.
    unsafe { command.pre_exec(ask) };
}
