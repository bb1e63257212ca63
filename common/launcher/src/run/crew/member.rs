//! One node of the crew and its process.

use std::io;
use std::path::Path;
use std::process::ExitStatus;
use std::sync::mpsc::Sender;
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

use anyhow::{Context, bail};
use command_line::{LOST_DATA, WRONG_USE};
use dataflow::Node;
use messages::LogLevel;
use nix::sys::signal::Signal;
use transport::{GraphName, log_in_graph};

use super::super::console::warn;
use super::super::control::NodeStatus;
use super::super::process::{Process, not_started};
use super::super::supervision::{AfterEnd, Ended, Pulse, Restarts, is_essential};
use crate::installed::is_ours;

/// Number of failures in a row from which a node is reported as failing.
const FAILURES_SHOWN: u32 = 3;
/// Longest part of its last line that is shown, in bytes.
const LINE_SHOWN: usize = 400;

pub(super) struct Member {
    pub(super) node: Node,
    pub(super) essential: bool,
    pub(super) restarts: Restarts,
    pub(super) pulse: Pulse,
    pub(super) state: State,
    pub(super) started: Option<Instant>,
    /// Number of restarts, and exit status of the last process that ended.
    pub(super) restarted: u64,
    pub(super) last_end: Option<ExitStatus>,
    pub(super) last_line: Arc<Mutex<String>>,
    /// Request of a user that follows the end of the process.
    pub(super) wanted: Option<Wanted>,
    /// A sentence if it failed for good and the graph continues without it.
    pub(super) given_up: Option<String>,
    /// True if the exit code of its last process says that it lost data.
    pub(super) lost_data: bool,
}

pub(super) enum Wanted {
    Restart,
    End,
}

pub(super) enum State {
    Due(Instant),
    Running(Process),
    Done,
}

impl Member {
    pub(super) fn new(node: Node, now: Instant) -> anyhow::Result<Self> {
        Ok(Member {
            essential: is_essential(&node)?,
            restarts: Restarts::new(node.restart),
            pulse: Pulse::new(node.restart.health_timeout, is_ours(&node)),
            state: State::Due(now),
            started: None,
            restarted: 0,
            last_end: None,
            last_line: Arc::default(),
            wanted: None,
            given_up: None,
            lost_data: false,
            node,
        })
    }

    pub(super) fn start_if_due(
        &mut self,
        now: Instant,
        folder: &Path,
        graph: &GraphName,
        open: &Sender<()>,
    ) -> anyhow::Result<()> {
        if !matches!(self.state, State::Due(at) if at <= now) {
            return Ok(());
        }
        let process = match Process::start(&self.node, folder, graph, (open, &self.last_line)) {
            Ok(process) => process,
            Err(source) => return self.not_started(source, folder, now),
        };
        // Logged in the graph only, not on the console.
        let started = format!("{} runs as process {}", self.node.id, process.pid());
        log_in_graph(LogLevel::Info, &started);
        self.restarted += u64::from(self.started.is_some());
        self.started = Some(now);
        self.pulse.started(now);
        self.state = State::Running(process);
        Ok(())
    }

    /// Retries a node that has run before: memory or processes may be short. Otherwise fails.
    fn not_started(
        &mut self,
        source: io::Error,
        folder: &Path,
        now: Instant,
    ) -> anyhow::Result<()> {
        let after = match self.started {
            Some(_) => self.restarts.after_end(Ended::Badly, Duration::ZERO, now),
            None => AfterEnd::Failed,
        };
        if let AfterEnd::Restart(delay) = after {
            let id = &self.node.id;
            warn(&format!(
                "{id} cannot be started and will be retried: {source}"
            ));
            self.state = State::Due(now + delay);
            return Ok(());
        }
        self.state = State::Done;
        Err(source).with_context(|| not_started(&self.node, folder))
    }

    /// Asks the process to end and notes what is wanted then; without one, `otherwise` follows now.
    pub(super) fn ask_to_end(&mut self, wanted: Wanted, otherwise: State) -> anyhow::Result<()> {
        let State::Running(process) = &self.state else {
            self.state = otherwise;
            return Ok(());
        };
        self.wanted = Some(wanted);
        let asked = process.signal(Signal::SIGTERM);
        asked.with_context(|| not_supervised(&self.node, process.pid()))
    }

    /// Returns true if the process has ended, after deciding what follows.
    pub(super) fn look_after(&mut self, now: Instant, has_room: bool) -> anyhow::Result<bool> {
        let Some(status) = self.poll()? else {
            self.end_if_hung(now)?;
            return Ok(false);
        };
        self.lost_data = lost_data(status);
        self.last_end = Some(status);
        if let Some(wanted) = self.wanted.take() {
            self.state = match wanted {
                Wanted::Restart => State::Due(now),
                Wanted::End => State::Done,
            };
            return Ok(true);
        }
        let ended = match how_ended(status) {
            Ended::Badly if !has_room => Ended::Starved,
            ended => ended,
        };
        self.state = match self.restarts.after_end(ended, self.worked(now), now) {
            AfterEnd::Done => State::Done,
            AfterEnd::Restart(delay) => {
                let id = &self.node.id;
                warn(&format!("{id} ended with {status} and is restarted"));
                State::Due(now + delay)
            }
            AfterEnd::Failed => {
                self.state = State::Done;
                let after = match self.restarts.used() {
                    0 => String::new(),
                    1 => " after 1 restart in short time".to_owned(),
                    n => format!(" after {n} restarts in short time"),
                };
                let id = &self.node.id;
                bail!("node {id} ended with {status}{after}; see its last log lines");
            }
        };
        // Warns once per row of failures; `Starved` is not counted in the row.
        if ended != Ended::Starved
            && self.restarts.in_a_row() == FAILURES_SHOWN
            && let Some(sentence) = self.fails(now)
        {
            warn(&sentence);
        }
        Ok(true)
    }

    /// Time at work; the lifetime if it does not report or is older than the restart window.
    fn worked(&self, now: Instant) -> Duration {
        let lived = self.started.map_or(Duration::ZERO, |started| now - started);
        match self.pulse.at_work_for(now) {
            Some(worked) if lived < self.node.restart.window => worked,
            _ => lived,
        }
    }

    pub(super) fn fails(&self, now: Instant) -> Option<String> {
        let is_running = matches!(self.state, State::Running(_));
        let has_recovered = is_running && self.worked(now) >= Restarts::RECOVERED_AFTER;
        let (id, times) = (&self.node.id, self.restarts.in_a_row());
        if times < FAILURES_SHOWN || has_recovered || matches!(self.state, State::Done) {
            return None;
        }
        let status = self.last_end?;
        let mut sentence = format!("{id} ended {times} times in a row, last with {status}");
        let last_line = self.last_line.lock().map(|line| line.clone());
        if let Some(line) = last_line.ok().filter(|line| !line.is_empty()) {
            let end = line.floor_char_boundary(LINE_SHOWN);
            sentence = format!("{sentence}: {}", &line[..end]);
        }
        Some(sentence)
    }

    pub(super) fn status(&self, now: Instant) -> NodeStatus {
        let (state, pid) = match &self.state {
            State::Due(_) => ("waiting to start", None),
            State::Running(process) => ("running", Some(process.pid())),
            State::Done => ("ended", None),
        };
        let up = self.started.filter(|_| pid.is_some());
        let reported = self.pulse.age(now).filter(|_| pid.is_some());
        NodeStatus {
            id: self.node.id.clone(),
            state: state.to_owned(),
            pid,
            uptime_s: up.map(|started| (now - started).as_secs()),
            reported_s: reported.map(|age| age.as_secs()),
            restarts: self.restarted,
            last_end: self.last_end.map(|status| status.to_string()),
            fails: self.fails(now),
        }
    }

    fn end_if_hung(&mut self, now: Instant) -> anyhow::Result<()> {
        let (Some(silent), State::Running(process)) = (self.pulse.missed_for(now), &self.state)
        else {
            return Ok(());
        };
        let (id, seconds) = (&self.node.id, silent.as_secs());
        warn(&format!(
            "{id} sent no heartbeat for {seconds} s and is killed"
        ));
        // Its end is handled later; until then it is not killed again.
        self.pulse.restart_timeout(now);
        let killed = process.signal(Signal::SIGKILL);
        killed.with_context(|| not_supervised(&self.node, process.pid()))
    }

    pub(super) fn poll(&mut self) -> anyhow::Result<Option<ExitStatus>> {
        let State::Running(process) = &mut self.state else {
            return Ok(None);
        };
        let pid = process.pid();
        let ended = process.poll();
        ended.with_context(|| not_supervised(&self.node, pid))
    }
}

/// A node that lost data has still done its work: a restart would do no better.
fn how_ended(status: ExitStatus) -> Ended {
    if status.success() || lost_data(status) {
        Ended::Well
    } else if status.code() == Some(WRONG_USE.into()) {
        Ended::Misused
    } else {
        Ended::Badly
    }
}

pub(super) fn lost_data(status: ExitStatus) -> bool {
    status.code() == Some(LOST_DATA.into())
}

pub(super) fn not_supervised(node: &Node, pid: i32) -> String {
    format!("node {}: process {pid} cannot be supervised", node.id)
}
