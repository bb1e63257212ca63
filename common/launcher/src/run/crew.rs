//! Starts, watches, restarts and stops the processes of the graph. When a node fails for good, the
//! run ends if it is essential, else [`Crew::problems`] says so.

mod member;

use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::time::{Duration, Instant};
use std::{io, thread};

use anyhow::Context;
use dataflow::Node;
use messages::{HealthHeader, NodeState};
use nix::sys::signal::Signal;
use transport::GraphName;

use self::member::{Member, State, Wanted, lost_data, not_supervised};
use super::console::warn;
use super::control::NodeStatus;
use super::process::Process;
use super::supervision::{is_over, is_source};

/// Time to end in order once asked to: for nodes without outputs, then for all others.
const GRACE: Duration = Duration::from_millis(700);
/// Wait for the last lines of ended processes; a process that left its group may hold a pipe.
const LAST_LINES: Duration = Duration::from_millis(100);
const STOP_POLL: Duration = Duration::from_millis(5);

pub struct Crew {
    members: Vec<Member>,
    folder: PathBuf,
    graph: GraphName,
    /// Each thread that forwards output holds a copy.
    output_open: Option<Sender<()>>,
    output_closed: Receiver<()>,
}

impl Crew {
    /// Creates the crew of `nodes`, in `folder`. Nothing runs before the first [`Crew::tick`].
    pub fn new(nodes: Vec<Node>, folder: &Path, graph: &GraphName) -> anyhow::Result<Self> {
        let now = Instant::now();
        let (output_open, output_closed) = channel();
        let members = nodes.into_iter().map(|node| Member::new(node, now));
        Ok(Crew {
            members: members.collect::<anyhow::Result<_>>()?,
            folder: folder.to_owned(),
            graph: graph.clone(),
            output_open: Some(output_open),
            output_closed,
        })
    }

    /// Starts nodes that are due and handles ended processes; true if there were any. Without
    /// `has_room`, shared memory is full and failures do not count.
    pub fn tick(&mut self, now: Instant, has_room: bool) -> anyhow::Result<bool> {
        let Some(open) = &self.output_open else {
            return Ok(false);
        };
        let mut any_ended = false;
        for member in &mut self.members {
            if !has_room {
                member.pulse.restart_timeout(now);
            }
            let started = member.start_if_due(now, &self.folder, &self.graph, open);
            let ended = started.and_then(|()| member.look_after(now, has_room));
            match ended {
                Ok(ended) => any_ended |= ended,
                Err(error) if !member.essential => {
                    any_ended = true;
                    let goes_on = format!("the graph continues without {}", member.node.id);
                    let sentence = format!("{error:#}; {goes_on}");
                    warn(&sentence);
                    member.given_up = Some(sentence);
                }
                Err(error) => return Err(error),
            }
        }
        Ok(any_ended)
    }

    pub fn received(&mut self, report: &HealthHeader, now: Instant) {
        let is_it = |member: &&mut Member| match &member.state {
            State::Running(process) => process.pid().cast_unsigned() == report.pid,
            _ => false,
        };
        if let Some(member) = self.members.iter_mut().find(is_it) {
            let state = NodeState::from_code(report.state);
            member.pulse.received(state, now);
        }
    }

    pub fn status(&self, now: Instant) -> Vec<NodeStatus> {
        let members = self.members.iter();
        members.map(|member| member.status(now)).collect()
    }

    /// Ends a node in order and starts it again at once; returns true if there is such a node.
    pub fn restart(&mut self, id: &str, now: Instant) -> anyhow::Result<bool> {
        let Some(member) = self.members.iter_mut().find(|member| member.node.id == id) else {
            return Ok(false);
        };
        member.given_up = None;
        member.ask_to_end(Wanted::Restart, State::Due(now))?;
        Ok(true)
    }

    /// Adds a node, in place of an ended one with its id, and starts it at the next tick.
    pub fn start(&mut self, node: Node, now: Instant) -> anyhow::Result<()> {
        self.members.retain(|member| member.node.id != node.id);
        self.members.push(Member::new(node, now)?);
        Ok(())
    }

    pub fn end(&mut self, id: &str) -> anyhow::Result<()> {
        let mut members = self.members.iter_mut().filter(|m| m.node.id == id);
        members.try_for_each(|member| member.ask_to_end(Wanted::End, State::Done))
    }

    /// Returns the node with this id if it runs or is due to start.
    pub fn active(&self, id: &str) -> Option<&Node> {
        let mut members = self.members.iter();
        let is_it = |m: &&Member| m.node.id == id && !matches!(m.state, State::Done);
        members.find(is_it).map(|member| &member.node)
    }

    /// A sentence for each node that failed for good and that the graph continues without.
    pub fn given_up(&self) -> impl Iterator<Item = String> {
        self.members.iter().filter_map(|m| m.given_up.clone())
    }

    /// Returns [`Crew::given_up`] and a sentence for each node that fails again and again.
    pub fn problems(&self, now: Instant) -> Vec<String> {
        let failing = self.members.iter().filter_map(|member| member.fails(now));
        self.given_up().chain(failing).collect()
    }

    /// True if the run is over: all sources or all nodes are done.
    pub fn is_over(&self) -> bool {
        is_over(self.members.iter().map(|member| {
            let done = matches!(member.state, State::Done);
            (is_source(&member.node), done)
        }))
    }

    /// Ends every process, by SIGTERM and 0.7 s later by SIGKILL. Nodes without outputs go first:
    /// when a publisher ends, samples that are not yet received are lost.
    pub fn stop(&mut self) -> anyhow::Result<()> {
        self.stop_those(|node| node.outputs.is_empty())?;
        self.stop_those(|_| true)?;
        self.output_open = None;
        // Nothing is ever sent: this waits for the last sender to be dropped.
        let _ = self.output_closed.recv_timeout(LAST_LINES);
        Ok(())
    }

    pub fn nodes_with_data_loss(&self) -> Vec<String> {
        let members = self.members.iter().filter(|member| member.lost_data);
        members.map(|member| member.node.id.clone()).collect()
    }

    /// Sends `signal` to all processes of one executable and returns their number.
    pub fn signal(&mut self, executable: &str, signal: Signal) -> anyhow::Result<usize> {
        let mut signalled = 0;
        let meant = |node: &Node| node.executable() == executable;
        self.for_each_running(meant, |process| {
            signalled += 1;
            process.signal(signal)
        })?;
        Ok(signalled)
    }

    fn stop_those(&mut self, meant: impl Fn(&Node) -> bool) -> anyhow::Result<()> {
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

    fn collect_ended(&mut self, meant: impl Fn(&Node) -> bool) -> anyhow::Result<usize> {
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
    ) -> anyhow::Result<()> {
        for member in self.members.iter_mut().filter(|member| meant(&member.node)) {
            if let State::Running(process) = &mut member.state {
                act(process).with_context(|| not_supervised(&member.node, process.pid()))?;
            }
        }
        Ok(())
    }
}
