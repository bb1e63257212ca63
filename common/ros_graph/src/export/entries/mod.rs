//! Converts samples of the graph to messages of ROS with their times, without I/O.
//!
//! The times are those of the measurements, not of their arrival: a scan, its votes and its
//! hypotheses have the same time, so that a recording that is replayed and recorded again has the
//! same times. Samples without a measurement (the map, the mount, health) wait for the first one
//! and get its time.

mod frames;
mod maps;

use std::borrow::Cow;
use std::collections::{BTreeMap, VecDeque};

use frames::Frames;
use messages::{
    Beam, BeamsHeader, FieldHeader, GroundTruth, HealthHeader, HypothesesHeader, Hypothesis,
    LogHeader, MapHeader, Odometry, Particle, ParticlesHeader, PoseHeader, ScanHeader, Stamp,
    Topic, Vote, VotesHeader, topic,
};
use recording::write::Encoded;
use ros::backcast_msgs as own;
use ros::{
    Header, LaserScan, Log, OccupancyGridMsg, PoseStamped, RosMessage, TfMessage, Time,
    diagnostics, lasers, poses,
};

use crate::export::error::Result;
use crate::export::{Options, TranscriptError, topics};

/// Largest number of health reports, and of log lines, that wait for the first measurement; the
/// newest are kept.
const MAX_WAITING: usize = 256;

#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Entry {
    Message(Encoded),
    /// Metadata that is valid from now on, with its name.
    Metadata(&'static str, BTreeMap<String, String>),
}

#[derive(Debug, Default)]
pub struct Entries {
    frames: Frames,
    map_frame: String,
    /// The newest measurement; relates the clock of measurements to the host's clock.
    newest: Option<Stamp>,
    /// The map that was recorded last, or is waiting.
    map: Option<MapHeader>,
    waiting_map: Option<OccupancyGridMsg>,
    waiting_health: VecDeque<(HealthHeader, String)>,
    waiting_log: VecDeque<(LogHeader, String)>,
    is_tracked: bool,
    made: Vec<Entry>,
}

impl Entries {
    pub fn new(options: &Options) -> Self {
        Entries {
            frames: Frames::new(&options.map_frame, &options.base_frame),
            map_frame: options.map_frame.clone(),
            ..Entries::default()
        }
    }

    pub fn take(&mut self) -> Vec<Entry> {
        std::mem::take(&mut self.made)
    }

    pub fn scan(&mut self, scan: &ScanHeader, ranges: &[f32]) -> Result {
        let at = self.measured(scan.stamp, topic::Scan::NAME)?;
        if let Some(mounts) = self.frames.on_scan(scan, at.stamp) {
            self.latched(topics::TF_STATIC, at.ns, &mounts)?;
        }
        let message = LaserScan::of(at.stamp, scan, ranges);
        match scan.laser.as_str() {
            "" => self.message(topics::SCAN, at.ns, &message),
            laser => self.message(lasers::topic_of(laser), at.ns, &message),
        }
    }

    pub fn odometry(&mut self, odometry: &Odometry) -> Result {
        let at = self.measured(odometry.stamp, topic::OdometryTopic::NAME)?;
        let transform = self.frames.on_odometry(odometry, at.stamp);
        self.message(topics::TF, at.ns, &transform)?;
        let message = ros::Odometry::of(at.stamp, odometry);
        self.message(topics::ODOM, at.ns, &message)
    }

    pub fn ground_truth(&mut self, truth: &GroundTruth) -> Result {
        let at = self.measured(truth.stamp, topic::GroundTruthTopic::NAME)?;
        let message = PoseStamped::of(at.stamp, truth);
        self.message(topics::GROUND_TRUTH, at.ns, &message)
    }

    pub fn votes(&mut self, votes: &VotesHeader, items: &[Vote]) -> Result {
        let at = self.measured(votes.stamp, topic::Votes::NAME)?;
        let map = self.map.as_ref();
        let map = map.filter(|map| map.map_id == votes.map_id);
        let message = own::Votes::of(self.in_map(at.stamp), (votes, items), map);
        self.message(topics::OWN_VOTES, at.ns, &message)
    }

    /// Adds the hypotheses of a scan, and the best pose if there is no tracker.
    pub fn hypotheses(&mut self, header: &HypothesesHeader, items: &[Hypothesis]) -> Result {
        let at = self.measured(header.stamp, topic::Hypotheses::NAME)?;
        let in_map = self.in_map(at.stamp);
        let own = own::Hypotheses::of(in_map.clone(), header, items);
        self.message(topics::OWN_HYPOTHESES, at.ns, &own)?;
        let array = poses::array(in_map.clone(), header, items);
        self.message(topics::HYPOTHESES, at.ns, &array)?;
        // If there is a tracker, it gives the pose of the robot.
        if self.is_tracked {
            return Ok(());
        }
        let (Some(best), Some(pose)) = (items.first(), poses::best(in_map, header, items)) else {
            return Ok(());
        };
        self.message(topics::POSE, at.ns, &pose)?;
        if let Some(transform) = self.frames.localized(header, best, at.stamp) {
            self.message(topics::TF, at.ns, &transform)?;
        }
        Ok(())
    }

    /// Adds initial particles for particle filters.
    pub fn particles(&mut self, header: &ParticlesHeader, items: &[Particle]) -> Result {
        let at = self.measured(header.stamp, topic::Particles::NAME)?;
        let array = poses::particles(self.in_map(at.stamp), items);
        self.message(topics::PARTICLES, at.ns, &array)
    }

    /// Notes that there is a tracker: from now on the results of single scans are no poses, even
    /// before its first pose.
    pub fn expect_tracker(&mut self) {
        self.is_tracked = true;
    }

    /// Adds the tracker's pose at a scan. Its poses between scans, which come from odometry, are
    /// left out, because the odometry is recorded itself.
    pub fn tracked(&mut self, header: &PoseHeader, words: &[u8]) -> Result {
        self.expect_tracker();
        if header.from_scan != 1 {
            return Ok(());
        }
        let at = self.measured(header.stamp, topic::Tracked::NAME)?;
        let own = own::TrackedPose::of(self.in_map(at.stamp), header, words);
        self.message(topics::OWN_POSE, at.ns, &own)?;
        if let Some(pose) = poses::tracked(self.in_map(at.stamp), header) {
            self.message(topics::POSE, at.ns, &pose)?;
        }
        if let Some(transform) = self.frames.tracked(header, at.stamp) {
            self.message(topics::TF, at.ns, &transform)?;
        }
        Ok(())
    }

    /// Adds the results of the beams of a scan at its best pose.
    pub fn beams(&mut self, beams: &BeamsHeader, items: &[Beam]) -> Result {
        let at = self.measured(beams.stamp, topic::Beams::NAME)?;
        let message = own::Beams::of(self.in_map(at.stamp), beams, items);
        self.message(topics::OWN_BEAMS, at.ns, &message)
    }

    /// Adds a map, unless it is the same as the last one: a restarted server sends it again.
    pub fn map(&mut self, map: &MapHeader, cells: &[u8], now_ns: i64) -> Result {
        let message = maps::occupancy_grid(map, cells)?;
        let known = self.map.replace(*map);
        if known.is_some_and(|known| known.map_id == map.map_id) {
            return Ok(());
        }
        self.waiting_map = Some(message);
        self.release_by_clock(now_ns)
    }

    /// Adds an intensity image; one of an unknown map is left out.
    pub fn field(&mut self, field: &FieldHeader, items: &[u16]) -> Result {
        let at = self.measured(field.stamp, topic::Field::NAME)?;
        let Some(map) = self.map.filter(|map| map.map_id == field.map_id) else {
            return Ok(());
        };
        let message = maps::field(self.in_map(at.stamp), field, items, &map)?;
        self.message(topics::FIELD, at.ns, &message)
    }

    /// Adds the health report of a node, at the host's time `now_ns`.
    pub fn health(&mut self, report: &HealthHeader, error: &[u8], now_ns: i64) -> Result {
        wait(&mut self.waiting_health, *report, error);
        self.release_by_clock(now_ns)
    }

    /// Adds a line of a node's log, at the time when it was written.
    pub fn log(&mut self, line: &LogHeader, text: &[u8]) -> Result {
        wait(&mut self.waiting_log, *line, text);
        self.release_by_clock(line.written_ns)
    }

    /// Converts all waiting samples at `wall_ns`, in nanoseconds since 1970, if there was no
    /// measurement.
    pub fn finish(&mut self, wall_ns: i64) -> Result {
        self.release(wall_ns)
    }

    /// Converts the waiting samples at the host's time, on the clock of the measurements, if there
    /// was any.
    fn release_by_clock(&mut self, now_ns: i64) -> Result {
        let Some(newest) = self.newest else {
            return Ok(());
        };
        let since_ns = now_ns.saturating_sub(newest.entered_ns).max(0);
        self.release(newest.measured_ns.saturating_add(since_ns))
    }

    /// Checks the stamp of a measurement; the first one releases the waiting samples.
    fn measured(&mut self, stamp: Stamp, topic: &'static str) -> Result<Moment> {
        let at = Moment::of(stamp.measured_ns, topic)?;
        let first = self.newest.is_none();
        if self
            .newest
            .is_none_or(|newest| newest.entered_ns <= stamp.entered_ns)
        {
            self.newest = Some(stamp);
        }
        if first {
            self.release(at.ns)?;
        }
        Ok(at)
    }

    fn release(&mut self, ns: i64) -> Result {
        let at = Moment::of(ns, topic::Map::NAME)?;
        if let (Some(mut map), Some(header)) = (self.waiting_map.take(), self.map) {
            map.header = self.in_map(at.stamp);
            map.info.map_load_time = at.stamp;
            self.made
                .push(Entry::Metadata("backcast/map", maps::metadata(&header)));
            self.latched(topics::MAP, at.ns, &map)?;
        }
        for (report, error) in std::mem::take(&mut self.waiting_health) {
            let message = diagnostics::of(at.stamp, &report, &error);
            self.message(topics::DIAGNOSTICS, at.ns, &message)?;
        }
        for (line, text) in std::mem::take(&mut self.waiting_log) {
            let message = Log::of(at.stamp, &line, &text);
            self.message(topics::ROSOUT, at.ns, &message)?;
        }
        Ok(())
    }

    fn in_map(&self, stamp: Time) -> Header {
        Header::new(stamp, &self.map_frame)
    }

    fn message<M: RosMessage>(
        &mut self,
        topic: impl Into<Cow<'static, str>>,
        ns: i64,
        message: &M,
    ) -> Result {
        let encoded = Encoded::new(topic, ns, message)?;
        self.made.push(Entry::Message(encoded));
        Ok(())
    }

    fn latched<M: RosMessage>(&mut self, topic: &'static str, ns: i64, message: &M) -> Result {
        let encoded = Encoded::latched(topic, ns, message)?;
        self.made.push(Entry::Message(encoded));
        Ok(())
    }
}

/// Adds a waiting sample; drops the oldest if there are too many.
fn wait<H>(waiting: &mut VecDeque<(H, String)>, header: H, text: &[u8]) {
    if waiting.len() == MAX_WAITING {
        waiting.pop_front();
    }
    waiting.push_back((header, String::from_utf8_lossy(text).into_owned()));
}

#[derive(Debug, Clone, Copy)]
struct Moment {
    ns: i64,
    stamp: Time,
}

impl Moment {
    fn of(ns: i64, topic: &'static str) -> Result<Self> {
        match Time::from_ns(ns) {
            Some(stamp) if ns >= 0 => Ok(Moment { ns, stamp }),
            _ => Err(TranscriptError::Stamp {
                topic,
                stamp_ns: ns,
            }),
        }
    }
}

fn transforms(transforms: Vec<ros::TransformStamped>) -> TfMessage {
    TfMessage { transforms }
}

#[cfg(test)]
mod tests;
