//! Receives scans and sends votes.

mod inputs;
mod outputs;
mod supply;

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use engine::heading::{HeadingSource, History};
use engine::localizer::Workspace;
use engine::scan::Scan;
use messages::{Vote, VotesHeader, topic};
use transport::{Flow, GapCounter, Graph, Health, Sample, TransportError, with_causes};

use crate::answer::{self, Answer, Image};
use crate::preparation::PreparedMap;
use crate::sonar::Sonar;
use crate::{AccumulatorError, Config};
use inputs::Inputs;
use outputs::Outputs;
use supply::Supply;

/// How long a map that has been prepared waits to be used at most, while no
/// scan comes.
const TICK: Duration = Duration::from_millis(50);

/// Readings of each kind that are kept to take headings and poses from: ten seconds
/// of odometry at 100 Hz.
const POSES_KEPT: usize = 1024;

/// Answers each scan with its votes until the stop flag is set.
///
/// # Errors
/// If the graph fails, or the thread that prepares a map dies. A scan or a map
/// that is refused is reported in `health`.
pub fn run(graph: &Graph, config: &Config) -> Result<(), AccumulatorError> {
    let source = config.heading.source();
    let inputs = Inputs::open(graph, config)?;
    let outputs = Outputs::open(graph, config)?;
    let mut node = Node {
        source,
        headings: config.localizer.headings,
        history: History::keeping(POSES_KEPT),
        supply: Supply::new(config.localizer.clone(), config.prior()),
        map: None,
        sonar: config.sonar.window().map(Sonar::new),
        workspace: Workspace::default(),
        gaps: GapCounter::new(),
        last_refusal: String::new(),
        outputs,
        stop: graph.stop_flag(),
        health: graph.health()?,
    };
    graph.run(&inputs.all(), TICK, |_| node.step(&inputs))
}

struct Node {
    source: HeadingSource,
    headings: u32,
    history: History,
    supply: Supply,
    map: Option<PreparedMap>,
    /// What scans are read through, where they are those of sonars.
    sonar: Option<Sonar>,
    /// For all maps, one after the other.
    workspace: Workspace,
    gaps: GapCounter,
    last_refusal: String,
    outputs: Outputs,
    stop: Arc<AtomicBool>,
    health: Health,
}

impl Node {
    /// Looks at the maps between any two scans, for a search may take long.
    fn step(&mut self, inputs: &Inputs) -> Result<Flow, AccumulatorError> {
        while !self.stopped() {
            let prepared = self.supply.poll(inputs, &mut self.health)?;
            self.map = prepared.or(self.map.take());
            self.health.tick()?;
            let scan = inputs.scans.receive()?;
            // What was sent before the scan has come by now.
            inputs.hear_poses(&mut self.history, &mut self.health)?;
            match scan {
                Some(scan) => self.answer(&scan)?,
                None => return Ok(Flow::Continue),
            }
        }
        Ok(Flow::Stop)
    }

    fn answer(&mut self, scan: &Sample<topic::Scan>) -> Result<(), TransportError> {
        let lost = self.gaps.lost_before(scan.header().stamp.counter);
        self.health.count_received(1);
        self.health.count_dropped(lost);
        let read = self.read_through(scan);
        // What is sent lies in the workspace.
        let mut workspace = std::mem::take(&mut self.workspace);
        let done = match read.and_then(|()| self.search(&mut workspace, scan)) {
            Ok(Some((votes, poses))) => self
                .send_votes(&votes, poses)
                .and_then(|()| self.send_field(&mut workspace, scan, &votes)),
            // Stopped half-way: nobody waits for the answer any more.
            Ok(None) => Ok(()),
            Err(error) => self.refuse(scan, &error),
        };
        self.workspace = workspace;
        done
    }

    /// Joins the scan with those before it, if it is one of sonars.
    fn read_through(&mut self, scan: &Sample<topic::Scan>) -> Result<(), AccumulatorError> {
        match &mut self.sonar {
            Some(sonar) => sonar.hear(scan.header(), scan.items(), &self.history),
            None => Ok(()),
        }
    }

    /// What is to vote.
    fn readings<'a>(&'a self, scan: &'a Sample<topic::Scan>) -> Result<Scan<'a>, AccumulatorError> {
        let as_it_came = answer::scan(scan.header(), scan.items())?;
        Ok(self.sonar.as_ref().map_or(as_it_came, Sonar::scan))
    }

    fn search<'w>(
        &self,
        workspace: &'w mut Workspace,
        scan: &Sample<topic::Scan>,
    ) -> Result<Option<Answer<'w>>, AccumulatorError> {
        let map = self.map.as_ref().ok_or(AccumulatorError::NoMap)?;
        let heading = self.source.heading_of(scan.header(), &self.history)?;
        let borrowed = self.readings(scan)?;
        let start = Instant::now();
        let stop = || self.stopped();
        let outcome = answer::ask(&map.localizer, workspace, &borrowed, heading, &stop)?;
        let engine_ns = start.elapsed().as_nanos() as u64;
        Ok(outcome.map(|outcome| answer::answered(scan.header(), map, outcome, engine_ns)))
    }

    fn stopped(&self) -> bool {
        self.stop.load(Ordering::Relaxed)
    }

    fn send_votes(&mut self, votes: &VotesHeader, poses: &[Vote]) -> Result<(), TransportError> {
        self.outputs.votes(votes, poses)?;
        self.health.count_sent(1);
        self.last_refusal.clear();
        Ok(())
    }

    /// Sends the image of the scan that was answered last, if one is due.
    fn send_field(
        &mut self,
        workspace: &mut Workspace,
        scan: &Sample<topic::Scan>,
        votes: &VotesHeader,
    ) -> Result<(), TransportError> {
        if self.outputs.is_field_due()
            && let Some((header, intensities)) = self.image(workspace, scan, votes)
        {
            self.outputs.field(&header, intensities)?;
            self.health.count_sent(1);
        }
        Ok(())
    }

    /// The image of a scan that was answered, so that nothing can be wrong with
    /// it any more.
    fn image<'w>(
        &self,
        workspace: &'w mut Workspace,
        scan: &Sample<topic::Scan>,
        votes: &VotesHeader,
    ) -> Option<Image<'w>> {
        let localizer = &self.map.as_ref()?.localizer;
        let borrowed = self.readings(scan).ok()?;
        answer::image(votes, localizer, workspace, &borrowed).ok()
    }

    /// Answers a refused scan all the same, for its source may be waiting.
    fn refuse(
        &mut self,
        scan: &Sample<topic::Scan>,
        error: &AccumulatorError,
    ) -> Result<(), TransportError> {
        let map_id = self.map.as_ref().map_or(0, |map| map.map_id);
        let votes = answer::refused(scan.header(), map_id, self.headings);
        self.outputs.votes(&votes, &[])?;
        self.health.count_sent(1);
        self.health.count_refused(1);
        let (counter, reason) = (scan.header().stamp.counter, with_causes(error));
        self.health
            .error(&format!("scan {counter} is refused: {reason}"))?;
        // A source that is always wrong would fill the log.
        if reason != self.last_refusal {
            tracing::warn!("scan {counter} is refused: {reason}");
            self.last_refusal = reason;
        }
        Ok(())
    }
}
