//! Course of a run: start, inject faults and observe the effects, stop, and summarize.

use std::collections::BTreeMap;
use std::fs::remove_file;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::RecvTimeoutError;
use std::time::{Duration, Instant};

use answers::statistics::Distribution;
use anyhow::Context;
use command_line::output;
use geometry::Pose;
use launcher::run::console::{LAUNCHER, say};
use launcher::run::control::{Answer, NodeStatus, Question, Status, ask};
use nix::sys::signal::Signal;
use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};
use transport::{GraphName, control_socket, files_of, monotonic_ns};

use super::fault::{Draw, Fault};
use super::filler::Filler;
use super::launched::{Launched, Losses, Printed, signal};
use super::maps::Maps;
use super::recorded::Recorded;
use super::report::Report;
use super::tally::Tally;
use super::usage::Usage;

/// Timeout for the first Unique pose, and for a pose after a fault.
const TIMEOUT: Duration = Duration::from_secs(60);
/// Longer gaps between poses are logged at once, so that they can be found in the log.
const LONG_GAP_S: f64 = 0.5;
const LOOK: Duration = Duration::from_secs(1);
const TICK: Duration = Duration::from_millis(50);

#[derive(Debug)]
pub(super) struct Plan {
    pub(super) arguments: Vec<String>,
    pub(super) victims: Vec<String>,
    pub(super) graph: GraphName,
    pub(super) lasts: Duration,
    pub(super) pause: Duration,
    pub(super) faults: Vec<Fault>,
    pub(super) seed: u64,
    /// Name of the recording's parts, on the disk that is filled.
    pub(super) record: Option<PathBuf>,
}

pub(super) struct Course {
    plan: Plan,
    maps: Maps,
    draw: Draw,
    launched: Launched,
    begin: Instant,
    tally: Tally,
    usage: Usage,
    losses: Losses,
    nodes: Vec<NodeStatus>,
    next_look: Instant,
    /// Number of restarts counted by launchers that have ended.
    earlier_restarts: u64,
    nodes_ended_s: Distribution,
    failures: Vec<String>,
    stop: Arc<AtomicBool>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Watched {
    Enough,
    Late,
    Over,
}

impl Course {
    pub(super) fn start(
        plan: Plan,
        maps: Maps,
        truths: BTreeMap<i64, Pose>,
    ) -> anyhow::Result<Self> {
        let stop = Arc::new(AtomicBool::new(false));
        for number in [SIGINT, SIGTERM, SIGHUP] {
            signal_hook::flag::register(number, Arc::clone(&stop))
                .context("cannot catch signals")?;
        }
        let now = Instant::now();
        Ok(Course {
            launched: Launched::start(&plan.arguments)?,
            draw: Draw::new(&plan.faults, plan.seed),
            begin: now,
            tally: Tally::new(truths, monotonic_ns(), plan.lasts),
            usage: Usage::default(),
            losses: Losses::default(),
            nodes: Vec::new(),
            next_look: now,
            earlier_restarts: 0,
            nodes_ended_s: Distribution::new(1000),
            failures: Vec::new(),
            plan,
            maps,
            stop,
        })
    }

    pub(super) fn run(mut self) -> anyhow::Result<Report> {
        // The graph may be built first, which may take any time.
        while self.watch(TIMEOUT, Tally::is_sure) == Watched::Late {
            if self.status().is_some() {
                self.fail(format!("no Unique pose within {TIMEOUT:?}"));
                break;
            }
        }
        let end = Instant::now() + self.plan.lasts;
        while Instant::now() < end && self.failures.is_empty() {
            let pause = self.plan.pause;
            if self.watch(pause, |_| false) == Watched::Over {
                break;
            }
            let Some(fault) = self.draw.fault() else {
                continue;
            };
            self.suffer(fault)?;
            if self.watch(TIMEOUT, Tally::has_recovered) == Watched::Late {
                self.fail(format!("no pose within {TIMEOUT:?} after {fault:?}"));
            }
            let gap_s = self.tally.last_gap_s();
            if gap_s > LONG_GAP_S {
                let gap = format!("the next pose was received after {gap_s:.2} s");
                say("soak", &gap);
            }
        }
        if self.failures.is_empty() && self.watch(TIMEOUT, Tally::is_sure) == Watched::Late {
            let open = self.tally.not_overcome();
            self.fail(format!("no Unique pose within {TIMEOUT:?} after {open:?}"));
        }
        self.finish()
    }

    fn fail(&mut self, reason: String) {
        self.failures.push(reason);
    }

    /// Processes output until the condition is met or the time is over.
    fn watch(&mut self, patience: Duration, enough: impl Fn(&Tally) -> bool) -> Watched {
        let deadline = Instant::now() + patience;
        loop {
            if self.stop.load(Ordering::Relaxed) {
                return Watched::Over;
            }
            if enough(&self.tally) {
                return Watched::Enough;
            }
            let now = Instant::now();
            if now >= deadline {
                return Watched::Late;
            }
            if now >= self.next_look {
                self.look();
            }
            match self.launched.lines().recv_timeout(TICK.min(deadline - now)) {
                Ok(printed) => self.take(&printed),
                Err(RecvTimeoutError::Timeout) => {}
                Err(RecvTimeoutError::Disconnected) => {
                    self.fail("the graph ended by itself".to_owned());
                    return Watched::Over;
                }
            }
        }
    }

    fn take(&mut self, printed: &Printed) {
        if let Some(pose) = &printed.pose {
            self.tally.pose(pose);
        }
        if let Some(losses) = printed.summary {
            self.losses.scans += losses.scans;
            self.losses.answered += losses.answered;
            self.losses.dropped += losses.dropped;
            self.losses.refused += losses.refused;
        }
    }

    fn look(&mut self) {
        self.next_look = Instant::now() + LOOK;
        let Some(status) = self.status() else {
            return;
        };
        self.nodes = status.nodes;
        // Usage during start-up says nothing about growth.
        if !self.tally.is_sure() && self.usage.nodes.is_empty() {
            return;
        }
        self.usage.look_at(LAUNCHER, self.launched.pid());
        for node in &self.nodes {
            if let Some(pid) = node.pid {
                self.usage.look_at(&node.id, pid);
            }
        }
        self.usage.look_at_files(&files_of(&self.plan.graph));
    }

    fn status(&self) -> Option<Status> {
        match ask(&control_socket(&self.plan.graph), &Question::Status) {
            Ok(Answer::Status(status)) => Some(status),
            _ => None,
        }
    }

    fn suffer(&mut self, fault: Fault) -> anyhow::Result<()> {
        let pids = self.choose(fault.nodes());
        let words: Vec<_> = pids.iter().map(|(id, _)| id.as_str()).collect();
        let seconds = self.begin.elapsed().as_secs();
        let words = format!("{seconds} s: {fault:?} {}", words.join(" "));
        say("soak", &words);
        let send = |number| pids.iter().try_for_each(|(_, pid)| signal(*pid, number));
        let mut over_ns = monotonic_ns();
        let mut killed = 0;
        match fault {
            Fault::Kill | Fault::Pair => {
                send(Signal::SIGKILL)?;
                killed = pids.len();
            }
            Fault::Stop => {
                send(Signal::SIGSTOP)?;
                self.watch(fault.lasts(), |_| false);
                over_ns = monotonic_ns();
                send(Signal::SIGCONT)?;
            }
            Fault::Map => self.maps.swap()?,
            Fault::Tmp => self.remove_files(),
            Fault::Launcher => over_ns = self.kill_launcher()?,
            Fault::Shm => over_ns = self.fill(Path::new("/dev/shm"), fault)?,
            Fault::Disk => {
                if let Some(file) = self.plan.record.clone() {
                    over_ns = self.fill(output::folder_of(&file), fault)?;
                }
            }
        }
        self.tally.suffered(fault, killed, over_ns);
        Ok(())
    }

    /// Chooses running nodes at random, from those that are restarted.
    fn choose(&mut self, count: usize) -> Vec<(String, i32)> {
        if count == 0 {
            return Vec::new();
        }
        if let Some(status) = self.status() {
            self.nodes = status.nodes;
        }
        let victims = self
            .nodes
            .iter()
            .filter(|n| self.plan.victims.contains(&n.id));
        let running: Vec<_> = victims
            .filter_map(|node| Some((node.id.clone(), node.pid?)))
            .collect();
        let chosen = self.draw.some_of(&running, count);
        chosen.into_iter().cloned().collect()
    }

    /// Removes files as a cleaner of the temporary folder would.
    fn remove_files(&self) {
        let files = files_of(&self.plan.graph).into_iter();
        for file in files.filter(|file| !file.starts_with("/dev/shm")) {
            // A file may have been removed meanwhile.
            let _ = remove_file(file);
        }
    }

    /// Fills a folder for a while; returns the time at which it was emptied.
    fn fill(&mut self, folder: &Path, fault: Fault) -> anyhow::Result<i64> {
        let filler = Filler::fill(folder)?;
        self.watch(fault.lasts(), |_| false);
        drop(filler);
        Ok(monotonic_ns())
    }

    /// Kills the launcher and starts another; returns the time of the start.
    fn kill_launcher(&mut self) -> anyhow::Result<i64> {
        if let Some(status) = self.status() {
            self.nodes = status.nodes;
        }
        self.earlier_restarts += restarts(&self.nodes);
        let killed = Instant::now();
        self.launched.kill()?;
        while let Ok(printed) = self.launched.lines().recv() {
            self.take(&printed);
        }
        let lives = |node: &NodeStatus| {
            let process = |pid| PathBuf::from(format!("/proc/{pid}"));
            node.pid.is_some_and(|pid| process(pid).exists())
        };
        while self.nodes.iter().any(lives) {
            if killed.elapsed() > TIMEOUT {
                self.fail("nodes went on without their launcher".to_owned());
                break;
            }
            std::thread::sleep(TICK / 10);
        }
        self.nodes_ended_s.add(killed.elapsed().as_secs_f64());
        self.nodes.clear();
        let started_ns = monotonic_ns();
        self.launched = Launched::start(&self.plan.arguments)?;
        Ok(started_ns)
    }

    fn finish(mut self) -> anyhow::Result<Report> {
        self.look();
        let seconds = self.begin.elapsed().as_secs_f64();
        let restarts = self.earlier_restarts + restarts(&self.nodes);
        self.launched.ask_to_stop()?;
        while let Ok(printed) = self.launched.lines().recv() {
            self.take(&printed);
        }
        let status = self.launched.wait()?;
        if !status.success() {
            self.fail(format!("the launcher ended with {status}"));
        }
        let record = self.plan.record.as_deref();
        let recorded = record.map(|file| Recorded::read(file, &mut self.failures));
        let left = files_of(&self.plan.graph).into_iter();
        Ok(Report {
            seconds,
            seed: self.plan.seed,
            tally: self.tally,
            losses: self.losses,
            nodes_ended_s: self.nodes_ended_s,
            restarts,
            usage: self.usage,
            recorded,
            leftovers: left.map(|file| file.display().to_string()).collect(),
            failures: self.failures,
        })
    }
}

fn restarts(nodes: &[NodeStatus]) -> u64 {
    nodes.iter().map(|node| node.restarts).sum()
}
