//! The processes of the graph: started, watched, started again, stopped.

use std::{
    io,
    path::{Path, PathBuf},
    process::ExitStatus,
    sync::mpsc::{Receiver, Sender, channel},
    thread,
    time::{Duration, Instant},
};

use dataflow::Node;
use messages::LogLevel;
use nix::sys::signal::Signal;
use transport::{GraphName, log_in_graph};

use super::{
    console::warn,
    process::{Process, executable},
    supervision::{AfterEnd, Restarts, is_over, is_source},
};
use crate::{BackcastError, cli::LOST_DATA};

/// What a process has to end in order once it is asked to. Those that send
/// nothing and then all others have as long; each of the two stays below a
/// second.
const GRACE: Duration = Duration::from_millis(700);
/// What the last lines of ended processes may take to reach the console: only a
/// process that left its group still holds a pipe open then.
const LAST_LINES: Duration = Duration::from_millis(100);
/// Between two looks at processes that are ending.
const STOP_POLL: Duration = Duration::from_millis(5);

/// All processes of a graph.
pub(crate) struct Crew {
    members: Vec<Member>,
    folder: PathBuf,
    graph: GraphName,
    /// Every thread that forwards output holds a copy.
    output_open: Option<Sender<()>>,
    output_closed: Receiver<()>,
}

struct Member {
    node: Node,
    restarts: Restarts,
    state: State,
    /// Whether it said so with its exit code.
    lost_data: bool,
}

enum State {
    /// To be started at this time.
    Due(Instant),
    Running(Process),
    Done,
}

impl Crew {
    /// The crew of `nodes`, in `folder`; nothing runs before the first
    /// [`Crew::tick`].
    pub(crate) fn new(nodes: Vec<Node>, folder: &Path, graph: &GraphName) -> Self {
        let now = Instant::now();
        let (output_open, output_closed) = channel();
        let member = |node: Node| Member {
            restarts: Restarts::new(node.restart),
            state: State::Due(now),
            lost_data: false,
            node,
        };
        Crew {
            members: nodes.into_iter().map(member).collect(),
            folder: folder.to_owned(),
            graph: graph.clone(),
            output_open: Some(output_open),
            output_closed,
        }
    }

    /// Starts what is due and looks after what has ended. Says whether any
    /// process has ended since the last time.
    ///
    /// # Errors
    /// A node cannot be started, or failed for good.
    pub(crate) fn tick(&mut self, now: Instant) -> Result<bool, BackcastError> {
        let Some(open) = &self.output_open else {
            return Ok(false);
        };
        let mut any_ended = false;
        for member in &mut self.members {
            member.start_if_due(now, &self.folder, &self.graph, open)?;
            any_ended |= member.look_after(now)?;
        }
        Ok(any_ended)
    }

    /// Whether nothing more can come of it.
    pub(crate) fn is_over(&self) -> bool {
        is_over(self.members.iter().map(|member| {
            let done = matches!(member.state, State::Done);
            (is_source(&member.node), done)
        }))
    }

    /// Ends every process: in order if it does so within the grace, else at
    /// once. What it said last has reached the console then.
    ///
    /// Those that send nothing go first: a sender takes along what nobody has
    /// taken yet.
    ///
    /// # Errors
    /// A process cannot be signalled or waited for.
    pub(crate) fn stop(&mut self) -> Result<(), BackcastError> {
        self.stop_those(|node| node.outputs.is_empty())?;
        self.stop_those(|_| true)?;
        self.output_open = None;
        // Nothing is ever sent: this waits for the last sender to be dropped.
        let _ = self.output_closed.recv_timeout(LAST_LINES);
        Ok(())
    }

    /// The nodes that said with their exit code that they lost data, by themselves
    /// or when they were ended.
    pub(crate) fn losers(&self) -> Vec<String> {
        let losers = self.members.iter().filter(|member| member.lost_data);
        losers.map(|member| member.node.id.clone()).collect()
    }

    /// Sends `signal` to the processes of one executable; returns how many there
    /// are.
    ///
    /// # Errors
    /// One cannot be signalled.
    pub(crate) fn signal(
        &mut self,
        executable: &str,
        signal: Signal,
    ) -> Result<usize, BackcastError> {
        let mut signalled = 0;
        let meant = |node: &Node| node.executable() == executable;
        self.for_each_running(meant, |process| {
            signalled += 1;
            process.signal(signal)
        })?;
        Ok(signalled)
    }

    fn stop_those(&mut self, meant: impl Fn(&Node) -> bool) -> Result<(), BackcastError> {
        self.for_each_running(&meant, |process| process.signal(Signal::SIGTERM))?;
        let deadline = Instant::now() + GRACE;
        while self.collect_ended(&meant)? > 0 && Instant::now() < deadline {
            thread::sleep(STOP_POLL);
        }
        self.for_each_running(&meant, Process::kill)?;
        for member in self.members.iter_mut().filter(|member| meant(&member.node)) {
            member.state = State::Done;
        }
        Ok(())
    }

    /// The number of processes that have not ended.
    fn collect_ended(&mut self, meant: impl Fn(&Node) -> bool) -> Result<usize, BackcastError> {
        let mut running = 0;
        for member in self.members.iter_mut().filter(|member| meant(&member.node)) {
            match member.poll()? {
                Some(status) => {
                    member.state = State::Done;
                    member.lost_data = lost_data(status);
                }
                None => running += usize::from(matches!(member.state, State::Running(_))),
            }
        }
        Ok(running)
    }

    fn for_each_running(
        &mut self,
        meant: impl Fn(&Node) -> bool,
        mut act: impl FnMut(&mut Process) -> io::Result<()>,
    ) -> Result<(), BackcastError> {
        for member in self.members.iter_mut().filter(|member| meant(&member.node)) {
            if let State::Running(process) = &mut member.state {
                act(process).map_err(|e| not_supervised(&member.node, process.pid(), e))?;
            }
        }
        Ok(())
    }
}

impl Member {
    fn start_if_due(
        &mut self,
        now: Instant,
        folder: &Path,
        graph: &GraphName,
        open: &Sender<()>,
    ) -> Result<(), BackcastError> {
        if !matches!(self.state, State::Due(at) if at <= now) {
            return Ok(());
        }
        let process = Process::start(&self.node, folder, graph, open).map_err(|source| {
            BackcastError::NotStarted {
                node: self.node.id.clone(),
                path: executable(&self.node, folder),
                folder: folder.to_owned(),
                source,
            }
        })?;
        // The console need not have it.
        let started = format!("{} runs as process {}", self.node.id, process.pid());
        log_in_graph(LogLevel::Info, &started);
        self.state = State::Running(process);
        Ok(())
    }

    /// Says whether the process has ended, after deciding what follows.
    fn look_after(&mut self, now: Instant) -> Result<bool, BackcastError> {
        let Some(status) = self.poll()? else {
            return Ok(false);
        };
        // Who did all that could be done, and lost data, would not do better anew.
        self.lost_data = lost_data(status);
        self.state = match self.restarts.after_end(status.success() || self.lost_data) {
            AfterEnd::Done => State::Done,
            AfterEnd::Restart(delay) => {
                let id = &self.node.id;
                warn(&format!("{id} ended with {status} and is started again"));
                State::Due(now + delay)
            }
            AfterEnd::Failed => {
                self.state = State::Done;
                return Err(BackcastError::NodeFailed {
                    node: self.node.id.clone(),
                    status,
                    restarts: self.restarts.used(),
                });
            }
        };
        Ok(true)
    }

    fn poll(&mut self) -> Result<Option<ExitStatus>, BackcastError> {
        let State::Running(process) = &mut self.state else {
            return Ok(None);
        };
        let pid = process.pid();
        process
            .poll()
            .map_err(|e| not_supervised(&self.node, pid, e))
    }
}

/// Whether a process said so.
fn lost_data(status: ExitStatus) -> bool {
    status.code() == Some(LOST_DATA.into())
}

fn not_supervised(node: &Node, pid: i32, source: io::Error) -> BackcastError {
    BackcastError::NotSupervised {
        node: node.id.clone(),
        pid,
        source,
    }
}
