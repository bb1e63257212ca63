//! Receives scans, odometry and search results, and publishes poses.

mod initial;
mod inputs;
mod map;
mod outputs;
mod search;
mod turn;

use std::time::{Duration, Instant};

use engine::EngineError;
use engine::joined::{ByOdometry, Joiner, ODOMETRY_WAIT_MS, Role};
use engine::tracking::{Candidate, Need, PlaceTracker};
use geometry::Pose;
use messages::{PoseHeader, ScanHeader, Stamp, TrackReason, TrackState};
use transport::{Flow, GapCounter, Graph, Health, TransportError, with_causes};

use crate::memory::{self, Remembered};
use crate::message::{Tracked, nothing};
use crate::queue::{Answers, Scans};
use crate::world::Worlds;
use crate::{Config, TrackerError};
use initial::Initial;
use inputs::Inputs;
use map::Served;
use outputs::Outputs;
use search::Searchers;
use turn::{Since, Turn};

/// Interval at which a scan waiting for odometry is checked while nothing arrives.
const TICK: Duration = Duration::from_millis(50);

const REMEMBERED_EVERY: Duration = Duration::from_secs(1);

const OTHER_SETTINGS: &str = "accumulator and peak_extractor read scans by other settings than this \
    tracker, so what they find is left out: start all three with the same --settings FILE";

pub fn run(graph: &Graph, config: &Config) -> Result<(), TrackerError> {
    let inputs = Inputs::open(graph)?;
    let file = config.remember.as_deref();
    let (remembered, unusable) = match file.map_or(Ok(None), memory::load) {
        Ok(found) => (found, None),
        Err(error) => (None, Some(error)),
    };
    let mut node = Node {
        config: config.clone(),
        settings: config.settings(),
        joiner: Joiner::new(config.join.clone()),
        worlds: Worlds::default(),
        served: None,
        shown: None,
        tracker: PlaceTracker::new(config.tracking),
        scans: Scans::default(),
        answers: Answers::default(),
        turn: Turn::Idle,
        looks: 0,
        asked: None,
        searchers: Searchers::default(),
        is_silent: false,
        before: None,
        initial: config.initial_pose.map(Initial::of_option),
        last: None,
        gaps: GapCounter::default(),
        last_refusal: String::new(),
        last_state: None,
        remembered,
        remembered_at: Instant::now(),
        outputs: Outputs::open(graph, config.rate)?,
        health: graph.health()?,
    };
    if let Some(error) = unusable {
        node.refuse(&format!("the robot is searched everywhere: {error}"))?;
    }
    graph.run(&inputs.all(), TICK, |_| {
        node.step(&inputs)?;
        Ok::<_, TrackerError>(Flow::Continue)
    })?;
    node.remember(true)
}

struct Node {
    config: Config,
    /// Id of the settings that the node shares with those that search.
    settings: u64,
    /// Newest scans, and the motion of the robot.
    joiner: Joiner,
    worlds: Worlds,
    served: Option<Served>,
    /// Id of the map of a set that is displayed.
    shown: Option<u64>,
    tracker: PlaceTracker,
    scans: Scans,
    answers: Answers,
    turn: Turn,
    /// Number of times that the node has checked its inputs.
    looks: u32,
    /// Scan whose search result will be used later.
    asked: Option<Stamp>,
    /// Processes that could answer when a search was last requested.
    searchers: Searchers,
    /// True if a search timed out and none was answered since: further ones are not awaited.
    is_silent: bool,
    /// Odometry of the target frame at the previous scan.
    before: Option<ByOdometry>,
    /// Initial pose received, to be used with the next scan.
    initial: Option<Initial>,
    last: Option<Tracked>,
    gaps: GapCounter,
    last_refusal: String,
    last_state: Option<TrackState>,
    remembered: Option<Remembered>,
    remembered_at: Instant,
    outputs: Outputs,
    health: Health,
}

impl Node {
    fn step(&mut self, inputs: &Inputs) -> Result<(), TrackerError> {
        self.looks = self.looks.wrapping_add(1);
        loop {
            self.take(inputs)?;
            self.health.tick()?;
            if !self.go_on(inputs)? {
                break;
            }
        }
        self.remember(false)
    }

    fn take(&mut self, inputs: &Inputs) -> Result<(), TrackerError> {
        // Messages sent before a scan have arrived when the scan has.
        while let Some(scan) = inputs.scans.receive()? {
            self.health.count_received(1);
            let dropped = self.scans.push(scan.header(), scan.items());
            self.health.count_dropped(dropped);
        }
        if let Some(set) = inputs.sets.newest()? {
            self.health.count_received(1);
            self.take_set(set.header(), set.items())?;
        }
        if let Some(map) = inputs.maps.newest()? {
            self.health.count_received(1);
            // While sets are published, this is the map of the set that is displayed.
            match inputs.sets.has_publishers() {
                true => self.shown = Some(map.header().map_id),
                false => self.take_map(map.header(), map.items())?,
            }
        }
        while let Some(found) = inputs.hypotheses.receive()? {
            self.health.count_received(1);
            match found.header().settings == self.settings {
                true => {
                    self.answers.push(found.header(), found.items());
                    self.is_silent = false;
                }
                false => self.refuse(OTHER_SETTINGS)?,
            }
        }
        while let Some(initial) = inputs.initial_poses.receive()? {
            self.health.count_received(1);
            self.take_initial(initial.header())?;
        }
        while let Some(odometry) = inputs.odometry.receive()? {
            self.health.count_received(1);
            self.joiner.on_odometry(odometry.header());
            self.carry(odometry.header().stamp)?;
        }
        Ok(())
    }

    /// Continues with the current scan or the next; returns true if there is more to do.
    fn go_on(&mut self, inputs: &Inputs) -> Result<bool, TrackerError> {
        match self.turn {
            Turn::Idle => self.next_scan(),
            Turn::Odometry { scan, since } => {
                let is_over = since.is_over(Duration::from_millis(ODOMETRY_WAIT_MS), self.looks);
                if self.joiner.lacks_odometry() && !is_over {
                    return Ok(false);
                }
                self.begin(inputs, &scan)?;
                Ok(true)
            }
            Turn::Search { scan, of, since } => self.wait_for_search(inputs, &scan, (of, since)),
        }
    }

    fn next_scan(&mut self) -> Result<bool, TrackerError> {
        let Some((scan, ranges)) = self.scans.pop() else {
            return Ok(false);
        };
        if self.joiner.on_scan(&scan, &ranges) == Role::Trigger {
            let lost = self.gaps.lost_before(scan.stamp.counter);
            self.health.count_dropped(lost);
            self.turn = Turn::Odometry {
                scan,
                since: Since::now(self.looks),
            };
        }
        Ok(true)
    }

    fn begin(&mut self, inputs: &Inputs, scan: &ScanHeader) -> Result<(), TrackerError> {
        let start = Instant::now();
        self.turn = Turn::Idle;
        if self.worlds.is_empty() {
            return self.send_nothing(scan, TrackReason::NoMap);
        }
        if let Err(error) = self.find_ends() {
            let (counter, reason) = (scan.stamp.counter, with_causes(&error));
            self.refuse(&format!("scan {counter} rejected: {reason}"))?;
            return self.send_nothing(scan, TrackReason::NoScan);
        }
        let is_set = self.begin_at_initial();
        let now = self.joiner.by_odometry();
        let moved = ByOdometry::between(self.before, now);
        self.before = now;
        // A believed initial pose is the pose at this scan.
        let moved = if is_set { Some(Pose::IDENTITY) } else { moved };
        let seen = self.worlds.seen(&self.config.fit);
        let of = match self.tracker.begin(&seen, scan.stamp.measured_ns, moved) {
            Need::Nothing => None,
            Need::ThisScan => {
                self.asked = None;
                self.ask(inputs, scan.stamp)?;
                Some(scan.stamp)
            }
            Need::EarlierScan => self.asked.take(),
        };
        match of {
            None => self.finish(inputs, scan, None, start),
            Some(of) => {
                self.turn = Turn::Search {
                    scan: *scan,
                    of,
                    since: Since::now(self.looks),
                };
                Ok(())
            }
        }
    }

    /// Joins the newest scans at a common time, and computes the end points of their beams.
    fn find_ends(&mut self) -> Result<(), EngineError> {
        self.joiner.bring()?;
        let seen = self.joiner.seen();
        self.worlds
            .find_ends(seen.observation(), &self.config.beams)
    }

    /// Completes a scan, with the search result for scan `of` if there is one.
    fn finish(
        &mut self,
        inputs: &Inputs,
        scan: &ScanHeader,
        of: Option<Stamp>,
        start: Instant,
    ) -> Result<(), TrackerError> {
        self.turn = Turn::Idle;
        let target = self.target();
        let worlds = &self.worlds;
        if worlds.is_empty() {
            return self.send_nothing(scan, TrackReason::NoMap);
        }
        let seen = worlds.seen(&self.config.fit);
        // If the search was refused or covered other maps, its result is unknown.
        let answer = of.and_then(|of| self.answers.of(of));
        let answer = answer.filter(|answer| answer.searched == worlds.searched());
        let found = answer.map(|answer| {
            let found = answer.found.iter();
            let known = found.filter_map(|found| Some((worlds.number(found.map_id)?, *found)));
            Candidate::of_hypotheses(answer.verdict, known, target)
        });
        self.tracker.finish(&seen, found.as_deref());
        if self.tracker.asks_ahead() {
            self.asked = Some(scan.stamp);
            self.ask(inputs, scan.stamp)?;
        }
        let report = self.tracker.report();
        // Without a pose, the robot is assumed to be on its last map.
        let map = report
            .pose
            .map_or_else(|| self.current_map(), |_| report.map);
        let last = Tracked {
            stamp: scan.stamp,
            map_id: self.worlds.map_id(map),
            map_name: self.worlds.name(map),
            report,
            target,
            mount_known: scan.mount_known == 1,
            by_odometry: self.before.map(|at| (at, self.joiner.odom_frame())),
            tracking_ns: start.elapsed().as_nanos() as u64,
        };
        self.last = Some(last);
        let words = last.report.words();
        self.log(last.report.state, &words);
        self.last_refusal.clear();
        Ok(self.send(last.header(), &words)?)
    }

    fn log(&mut self, state: TrackState, words: &str) {
        if self.last_state != Some(state) {
            tracing::info!("{state}: {words}");
            self.last_state = Some(state);
        }
    }

    /// Publishes the pose extrapolated by odometry, if one is due.
    fn carry(&mut self, stamp: Stamp) -> Result<(), TransportError> {
        if !self.outputs.is_due() {
            return Ok(());
        }
        // There is no pose on a map that is no longer served.
        let may_go_on = |last: &Tracked| {
            last.report.state != TrackState::Searching && self.worlds.number(last.map_id).is_some()
        };
        let Some(last) = self.last.filter(may_go_on) else {
            return Ok(());
        };
        let newest = self.joiner.by_newest_odometry();
        let error = self.config.tracking.odometry_error;
        let Some(carried) = newest.and_then(|newest| last.carried(newest, error)) else {
            return Ok(());
        };
        let words = carried.report.words();
        self.log(carried.report.state, &words);
        self.send(carried.header_at(stamp, false), &words)
    }

    fn send_nothing(&mut self, scan: &ScanHeader, reason: TrackReason) -> Result<(), TrackerError> {
        let map_id = self.worlds.map_id(self.current_map());
        Ok(self.send(nothing(scan.stamp, map_id, reason), "")?)
    }

    fn send(&mut self, header: PoseHeader, words: &str) -> Result<(), TransportError> {
        self.outputs.pose(header, words)?;
        self.health.count_sent(1);
        Ok(())
    }

    /// Saves the last unique pose, periodically and at the end.
    fn remember(&mut self, is_end: bool) -> Result<(), TrackerError> {
        let Some(file) = &self.config.remember else {
            return Ok(());
        };
        let is_due = is_end || self.remembered_at.elapsed() >= REMEMBERED_EVERY;
        let Some(last) = self
            .last
            .filter(|last| is_due && last.report.state == TrackState::Unique)
        else {
            return Ok(());
        };
        let header = last.header();
        self.remembered_at = Instant::now();
        let pose = Remembered {
            map_id: format!("{:016x}", last.map_id),
            stamp_ns: last.stamp.measured_ns,
            map_from_base: header.map_from_base.into(),
            covariance: header.base_covariance,
        };
        match memory::save(file, &pose) {
            Err(error) if !is_end => Ok(self.refuse(&with_causes(&error))?),
            other => other,
        }
    }

    /// Reports a problem; logs it once for as long as it stays the same.
    fn refuse(&mut self, problem: &str) -> Result<(), TransportError> {
        self.health.count_refused(1);
        self.health.error(problem)?;
        if problem != self.last_refusal {
            tracing::warn!("{problem}");
            self.last_refusal = problem.to_owned();
        }
        Ok(())
    }
}
