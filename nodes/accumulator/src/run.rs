//! Receives scans and publishes votes.

mod inputs;
mod outputs;
mod supply;

use std::collections::BTreeMap;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use bytemuck::Zeroable;
use engine::fit::Readings;
use engine::heading::{HeadingSource, History};
use engine::joined::{JoinConfig, Joiner, Kept, ODOMETRY_WAIT_MS, Role, Seen};
use engine::vote_search::Workspace;
use messages::{ScanHeader, SearchOutcome, VotesHeader, searched_id};
use transport::{Flow, GapCounter, Graph, Health, TransportError, with_causes};

use crate::answer::{self, Answer, Image};
use crate::config::Searched;
use crate::kept::{Asked, KeptScan, KeptScans};
use crate::preparation::PreparedMap;
use crate::sonar::Sonar;
use crate::{AccumulatorError, Config};
use inputs::Inputs;
use outputs::Outputs;
use supply::Supply;

/// Longest time before a prepared map is used, and interval of checks for odometry.
const TICK: Duration = Duration::from_millis(25);

/// Readings of each kind kept for interpolation: ten seconds of odometry at 100 Hz.
const POSES_KEPT: usize = 1024;

/// Publishes the votes of each scan; a rejected scan or map is reported in `health`.
pub fn run(graph: &Graph, config: &Config) -> Result<(), AccumulatorError> {
    let source = config.heading.source();
    let inputs = Inputs::open(graph, config)?;
    let outputs = Outputs::open(graph, config)?;
    let mut node = Node {
        source,
        headings: config.vote_search.headings,
        history: History::keeping(POSES_KEPT, &config.join.motion),
        joiner: Joiner::new(join_config(config)),
        pending: None,
        kept: (config.search == Searched::Asked).then(KeptScans::default),
        recalled: None,
        supply: Supply::new(config),
        maps: Vec::new(),
        sonar: config.sonar.window().map(Sonar::new),
        workspaces: Vec::new(),
        readings: Readings::default(),
        gaps: BTreeMap::new(),
        last_notes: String::new(),
        last_refusal: String::new(),
        outputs,
        stop: graph.stop_flag(),
        health: graph.health()?,
    };
    graph.run(&inputs.all(), TICK, |_| node.step(&inputs))
}

/// Disables deskewing for a ring of sonars, which has its own window.
fn join_config(config: &Config) -> JoinConfig {
    let mut join = config.join.clone();
    join.motion.deskew &= config.sonar.sonar_way.is_none();
    join
}

struct Node {
    source: HeadingSource,
    headings: u32,
    history: History,
    /// Newest scans, and the motion of the robot.
    joiner: Joiner,
    /// Scan to be answered, and its time of arrival.
    pending: Option<(ScanHeader, Instant)>,
    /// Recent scans, if only requested ones are searched.
    kept: Option<KeptScans>,
    /// Content of the requested scan during its search.
    recalled: Option<Kept>,
    supply: Supply,
    maps: Vec<PreparedMap>,
    sonar: Option<Sonar>,
    workspaces: Vec<Workspace>,
    readings: Readings,
    gaps: BTreeMap<String, GapCounter>,
    last_notes: String,
    last_refusal: String,
    outputs: Outputs,
    stop: Arc<AtomicBool>,
    health: Health,
}

impl Node {
    /// Processes the inputs; checks for new maps between any two scans, as a search takes long.
    fn step(&mut self, inputs: &Inputs) -> Result<Flow, AccumulatorError> {
        while !self.stopped() {
            if let Some(prepared) = self.supply.poll(inputs, &mut self.health)? {
                self.maps = prepared;
            }
            self.health.tick()?;
            while self.pending.is_none() && self.take_scan(inputs)? {}
            // Messages sent before the scan have arrived by now.
            inputs.take_poses(&mut self.joiner, &mut self.history, &mut self.health)?;
            let Some((scan, since)) = self.pending.take() else {
                if self.answer_asked(inputs)? {
                    continue;
                }
                return Ok(Flow::Continue);
            };
            if self.joiner.lacks_odometry()
                && since.elapsed() < Duration::from_millis(ODOMETRY_WAIT_MS)
            {
                self.pending = Some((scan, since));
                return Ok(Flow::Continue);
            }
            let brought = self.bring(&scan);
            match (&mut self.kept, brought) {
                (Some(kept), Ok(lasers)) => {
                    kept.keep(&scan, lasers, &self.joiner.seen());
                    self.send_unsearched(&scan, SearchOutcome::NotAsked)?;
                }
                (_, brought) => self.answer(&scan, brought)?,
            }
        }
        Ok(Flow::Stop)
    }

    fn answer_asked(&mut self, inputs: &Inputs) -> Result<bool, TransportError> {
        let (Some(kept), Some(attention)) = (&mut self.kept, &inputs.attention) else {
            return Ok(false);
        };
        while let Some(request) = attention.receive()? {
            self.health.count_received(1);
            kept.request(request.header().stamp);
        }
        match kept.next() {
            None => return Ok(false),
            Some(Asked::Search(scan)) => {
                let KeptScan {
                    header,
                    lasers,
                    kept,
                } = *scan;
                self.recalled = Some(kept);
                self.answer(&header, Ok(lasers))?;
                self.recalled = None;
            }
            Some(Asked::Refuse(stamp)) => {
                let scan = ScanHeader {
                    stamp,
                    ..ScanHeader::zeroed()
                };
                self.refuse(&scan, &AccumulatorError::NotKept)?;
            }
        }
        Ok(true)
    }

    fn take_scan(&mut self, inputs: &Inputs) -> Result<bool, TransportError> {
        let Some(scan) = inputs.scans.receive()? else {
            return Ok(false);
        };
        let header = *scan.header();
        let role = self.joiner.on_scan(&header, scan.items());
        if role == Role::Other {
            return Ok(true);
        }
        let gaps = self.gaps.entry(header.laser.to_string()).or_default();
        self.health
            .count_dropped(gaps.lost_before(header.stamp.counter));
        self.health.count_received(1);
        if role == Role::Trigger {
            self.pending = Some((header, Instant::now()));
        }
        Ok(true)
    }

    fn answer(
        &mut self,
        scan: &ScanHeader,
        brought: Result<u32, AccumulatorError>,
    ) -> Result<(), TransportError> {
        // The messages borrow from the workspaces.
        let mut workspaces = std::mem::take(&mut self.workspaces);
        let mut readings = std::mem::take(&mut self.readings);
        let found =
            brought.and_then(|lasers| self.search((&mut workspaces, &mut readings), scan, lasers));
        self.readings = readings;
        let done = match found {
            Ok(Some((leading, by_map))) => {
                let votes = by_map[leading].0;
                self.send_votes(&votes, &by_map)
                    .and_then(|()| self.send_field((leading, &mut workspaces[leading]), &votes))
            }
            // Interrupted by the stop flag: no one waits for the answer.
            Ok(None) => Ok(()),
            Err(error) => self.refuse(scan, &error),
        };
        self.workspaces = workspaces;
        done
    }

    /// Joins the scan with other lasers' or the sonar window; returns the number joined.
    fn bring(&mut self, scan: &ScanHeader) -> Result<u32, AccumulatorError> {
        let brought = self.joiner.bring()?;
        if let Some(sonar) = &mut self.sonar
            && let Seen::Still(ranges) = self.joiner.seen()
        {
            sonar.receive(scan, &ranges, &self.history)?;
        }
        let notes = brought.notes(self.joiner.flows()).join("; ");
        self.note(&notes)?;
        Ok(match self.joiner.targets_base() {
            true => brought.lasers,
            false => 0,
        })
    }

    /// Reports problems of joining, once for as long as they stay the same.
    fn note(&mut self, notes: &str) -> Result<(), TransportError> {
        if notes != self.last_notes {
            if !notes.is_empty() {
                tracing::warn!("{notes}");
                self.health.error(notes)?;
            }
            self.last_notes = notes.to_owned();
        }
        Ok(())
    }

    fn search<'w>(
        &self,
        (workspaces, readings): (&'w mut Vec<Workspace>, &mut Readings),
        scan: &ScanHeader,
        lasers: u32,
    ) -> Result<Option<(usize, Vec<Answer<'w>>)>, AccumulatorError> {
        if self.maps.is_empty() {
            return Err(AccumulatorError::NoMap);
        }
        let heading = self.source.heading_of(scan, &self.history)?;
        let heading = heading.map(|heading| self.joiner.target_heading(heading));
        let seen = self.seen();
        let observation = seen.observation();
        let start = Instant::now();
        let stop = || self.stopped();
        let leading = answer::ask(&self.maps, workspaces, observation, heading, &stop)?;
        let engine_ns = start.elapsed().as_nanos() as u64;
        let Some(leading) = leading else {
            return Ok(None);
        };
        let has_readings = matches!(seen, Seen::Carried(_));
        let searched = searched_id(self.maps.iter().map(|map| map.map_id));
        let workspaces = &*workspaces;
        let by_map = self.maps.iter().zip(workspaces).map(|(map, workspace)| {
            let (mut votes, poses) = answer::answered(scan, map, workspace.outcome(), engine_ns);
            votes.lasers_used = lasers;
            votes.has_readings = has_readings.into();
            votes.searched = searched;
            (votes, poses)
        });
        if has_readings {
            let map = &self.maps[leading];
            let beams = &map.vote_search.config().votes.beams;
            readings.find(observation, &map.space, beams)?;
            self.outputs.readings(scan.stamp, &readings.found)?;
        }
        Ok(Some((leading, by_map.collect())))
    }

    fn seen(&self) -> Seen<'_> {
        match (&self.sonar, &self.recalled) {
            (Some(sonar), _) => Seen::Still(sonar.scan()),
            (None, Some(kept)) => kept.seen(),
            (None, None) => self.joiner.seen(),
        }
    }

    fn stopped(&self) -> bool {
        self.stop.load(Ordering::Relaxed)
    }

    fn send_votes(
        &mut self,
        leading: &VotesHeader,
        by_map: &[Answer<'_>],
    ) -> Result<(), TransportError> {
        match by_map {
            [(votes, poses)] => self.outputs.votes(votes, poses)?,
            _ => self.outputs.votes_of_maps(leading, by_map)?,
        }
        self.health.count_sent(1);
        self.last_refusal.clear();
        Ok(())
    }

    fn send_field(
        &mut self,
        searched: (usize, &mut Workspace),
        votes: &VotesHeader,
    ) -> Result<(), TransportError> {
        if self.outputs.is_field_due()
            && let Some((header, intensities)) = self.image(searched, votes)
        {
            self.outputs.field(&header, intensities)?;
            self.health.count_sent(1);
        }
        Ok(())
    }

    fn image<'w>(
        &self,
        (map, workspace): (usize, &'w mut Workspace),
        votes: &VotesHeader,
    ) -> Option<Image<'w>> {
        let vote_search = &self.maps.get(map)?.vote_search;
        answer::image(votes, vote_search, workspace, self.seen().observation()).ok()
    }

    fn send_unsearched(
        &self,
        scan: &ScanHeader,
        outcome: SearchOutcome,
    ) -> Result<(), TransportError> {
        let map_id = self.maps.first().map_or(0, |map| map.map_id);
        let votes = answer::unsearched(scan, outcome, map_id, self.headings);
        self.outputs.votes(&votes, &[])
    }

    /// Answers a refused scan, because its sender may be waiting, and reports the reason.
    fn refuse(
        &mut self,
        scan: &ScanHeader,
        error: &AccumulatorError,
    ) -> Result<(), TransportError> {
        self.send_unsearched(scan, SearchOutcome::Refused)?;
        self.health.count_sent(1);
        self.health.count_refused(1);
        let (counter, reason) = (scan.stamp.counter, with_causes(error));
        self.health
            .error(&format!("scan {counter} rejected: {reason}"))?;
        // A persistent fault would otherwise fill the log.
        if reason != self.last_refusal {
            tracing::warn!("scan {counter} rejected: {reason}");
            self.last_refusal = reason;
        }
        Ok(())
    }
}
