//! From samples of the graph to messages of ROS, each with its time.
//!
//! Pure. Times are those of the measurements, not of their arrival: of a scan,
//! its votes and its hypotheses alike, so that a recording that is played and
//! recorded again has the same times. What has no measurement (the map, the
//! mount, health) waits for the first one, and then stands at its time.

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

use crate::{Options, TranscriptError, topics};

/// Reports, and lines, that wait for the first measurement at most; the newest are
/// kept.
const MAX_WAITING: usize = 256;

/// What goes into a transcript.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Entry {
    /// A message.
    Message(Encoded),
    /// What holds from now on, under a name.
    Metadata(&'static str, BTreeMap<String, String>),
}

/// Makes entries of samples.
#[derive(Debug)]
pub struct Entries {
    frames: Frames,
    map_frame: String,
    /// The newest measurement: where the clock of measurements meets the host's.
    newest: Option<Stamp>,
    /// The map that was recorded last, or is to be.
    map: Option<MapHeader>,
    waiting_map: Option<OccupancyGridMsg>,
    waiting_health: VecDeque<(HealthHeader, String)>,
    waiting_log: VecDeque<(LogHeader, String)>,
    /// Whether there is a tracker.
    is_tracked: bool,
    made: Vec<Entry>,
}

impl Entries {
    /// Nothing yet.
    #[must_use]
    pub fn new(options: &Options) -> Self {
        Entries {
            frames: Frames::new(&options.map_frame, &options.base_frame),
            map_frame: options.map_frame.clone(),
            newest: None,
            map: None,
            waiting_map: None,
            waiting_health: VecDeque::new(),
            waiting_log: VecDeque::new(),
            is_tracked: false,
            made: Vec::new(),
        }
    }

    /// What was made since the last call.
    pub fn take(&mut self) -> Vec<Entry> {
        std::mem::take(&mut self.made)
    }

    /// Takes a scan.
    ///
    /// # Errors
    /// If its stamp is no time of ROS, or CDR cannot say it.
    pub fn scan(&mut self, scan: &ScanHeader, ranges: &[f32]) -> Result<(), TranscriptError> {
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

    /// Takes odometry.
    ///
    /// # Errors
    /// If its stamp is no time of ROS, or CDR cannot say it.
    pub fn odometry(&mut self, odometry: &Odometry) -> Result<(), TranscriptError> {
        let at = self.measured(odometry.stamp, topic::OdometryTopic::NAME)?;
        let transform = self.frames.on_odometry(odometry, at.stamp);
        self.message(topics::TF, at.ns, &transform)?;
        let message = ros::Odometry::of(at.stamp, odometry);
        self.message(topics::ODOM, at.ns, &message)
    }

    /// Takes where the robot truly was.
    ///
    /// # Errors
    /// If its stamp is no time of ROS, or CDR cannot say it.
    pub fn ground_truth(&mut self, truth: &GroundTruth) -> Result<(), TranscriptError> {
        let at = self.measured(truth.stamp, topic::GroundTruthTopic::NAME)?;
        let message = PoseStamped::of(at.stamp, truth);
        self.message(topics::GROUND_TRUTH, at.ns, &message)
    }

    /// Takes the votes of a scan.
    ///
    /// # Errors
    /// If its stamp is no time of ROS, or CDR cannot say it.
    pub fn votes(&mut self, votes: &VotesHeader, items: &[Vote]) -> Result<(), TranscriptError> {
        let at = self.measured(votes.stamp, topic::Votes::NAME)?;
        let map = self.map.as_ref();
        let map = map.filter(|map| map.map_id == votes.map_id);
        let message = own::Votes::of(self.in_map(at.stamp), (votes, items), map);
        self.message(topics::OWN_VOTES, at.ns, &message)
    }

    /// Takes the places of a scan.
    ///
    /// # Errors
    /// If its stamp is no time of ROS, or CDR cannot say it.
    pub fn hypotheses(
        &mut self,
        header: &HypothesesHeader,
        items: &[Hypothesis],
    ) -> Result<(), TranscriptError> {
        let at = self.measured(header.stamp, topic::Hypotheses::NAME)?;
        let in_map = self.in_map(at.stamp);
        let own = own::Hypotheses::of(in_map.clone(), header, items);
        self.message(topics::OWN_HYPOTHESES, at.ns, &own)?;
        let array = poses::array(in_map.clone(), header, items);
        self.message(topics::HYPOTHESES, at.ns, &array)?;
        // Where there is a tracker, it says where the robot is.
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

    /// Takes a start for particle filters.
    ///
    /// # Errors
    /// If its stamp is no time of ROS, or CDR cannot say it.
    pub fn particles(
        &mut self,
        header: &ParticlesHeader,
        items: &[Particle],
    ) -> Result<(), TranscriptError> {
        let at = self.measured(header.stamp, topic::Particles::NAME)?;
        let array = poses::particles(self.in_map(at.stamp), items);
        self.message(topics::PARTICLES, at.ns, &array)
    }

    /// There is a tracker: answers to single scans are no poses, before its first one either.
    pub fn expect_tracker(&mut self) {
        self.is_tracked = true;
    }

    /// Takes where the tracker has the robot at a scan; what odometry carries on between
    /// scans is left out, for the odometry is there itself.
    ///
    /// # Errors
    /// If its stamp is no time of ROS, or CDR cannot say it.
    pub fn tracked(&mut self, header: &PoseHeader, words: &[u8]) -> Result<(), TranscriptError> {
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

    /// Takes how the beams of a scan fare at its best place.
    ///
    /// # Errors
    /// If its stamp is no time of ROS, or CDR cannot say it.
    pub fn beams(&mut self, beams: &BeamsHeader, items: &[Beam]) -> Result<(), TranscriptError> {
        let at = self.measured(beams.stamp, topic::Beams::NAME)?;
        let message = own::Beams::of(self.in_map(at.stamp), beams, items);
        self.message(topics::OWN_BEAMS, at.ns, &message)
    }

    /// Takes a map, unless it is the one that was taken last: a server that was
    /// started again sends it again.
    ///
    /// # Errors
    /// If its header and items contradict each other, its stamp is no time of ROS, or
    /// CDR cannot say it.
    pub fn map(
        &mut self,
        map: &MapHeader,
        cells: &[u8],
        now_ns: i64,
    ) -> Result<(), TranscriptError> {
        let message = maps::occupancy_grid(map, cells)?;
        let known = self.map.replace(*map);
        if known.is_some_and(|known| known.map_id == map.map_id) {
            return Ok(());
        }
        self.waiting_map = Some(message);
        match self.clock_ns(now_ns) {
            Some(ns) => self.release(ns),
            None => Ok(()),
        }
    }

    /// Takes an intensity image; one of a map that is not known is left out.
    ///
    /// # Errors
    /// If its header and items contradict each other, its stamp is no time of ROS, or
    /// CDR cannot say it.
    pub fn field(&mut self, field: &FieldHeader, items: &[u16]) -> Result<(), TranscriptError> {
        let at = self.measured(field.stamp, topic::Field::NAME)?;
        let Some(map) = self.map.filter(|map| map.map_id == field.map_id) else {
            return Ok(());
        };
        let message = maps::field(self.in_map(at.stamp), field, items, &map)?;
        self.message(topics::FIELD, at.ns, &message)
    }

    /// Takes a node's report, at the host's time `now_ns`.
    ///
    /// # Errors
    /// If the time of the measurements is not one of ROS, or CDR cannot say it.
    pub fn health(
        &mut self,
        report: &HealthHeader,
        error: &[u8],
        now_ns: i64,
    ) -> Result<(), TranscriptError> {
        wait(&mut self.waiting_health, *report, error);
        match self.clock_ns(now_ns) {
            Some(ns) => self.release(ns),
            None => Ok(()),
        }
    }

    /// Takes a line of a node's log, which stands at the time when it was written.
    ///
    /// # Errors
    /// If the time of the measurements is not one of ROS, or CDR cannot say it.
    pub fn log(&mut self, line: &LogHeader, text: &[u8]) -> Result<(), TranscriptError> {
        wait(&mut self.waiting_log, *line, text);
        match self.clock_ns(line.written_ns) {
            Some(ns) => self.release(ns),
            None => Ok(()),
        }
    }

    /// Makes entries of what still waits, where nothing was ever measured: at
    /// `wall_ns`, nanoseconds since 1970.
    ///
    /// # Errors
    /// If the time of the measurements is not one of ROS, or CDR cannot say it.
    pub fn finish(&mut self, wall_ns: i64) -> Result<(), TranscriptError> {
        self.release(wall_ns)
    }

    /// The clock of the measurements now.
    fn clock_ns(&self, now_ns: i64) -> Option<i64> {
        let newest = self.newest?;
        let since_ns = now_ns.saturating_sub(newest.entered_ns).max(0);
        Some(newest.measured_ns.saturating_add(since_ns))
    }

    /// Checks a measurement's stamp, and drops what waited for it.
    fn measured(&mut self, stamp: Stamp, topic: &'static str) -> Result<Moment, TranscriptError> {
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

    fn release(&mut self, ns: i64) -> Result<(), TranscriptError> {
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
    ) -> Result<(), TranscriptError> {
        let encoded = Encoded::new(topic, ns, message)?;
        self.made.push(Entry::Message(encoded));
        Ok(())
    }

    fn latched<M: RosMessage>(
        &mut self,
        topic: &'static str,
        ns: i64,
        message: &M,
    ) -> Result<(), TranscriptError> {
        let encoded = Encoded::latched(topic, ns, message)?;
        self.made.push(Entry::Message(encoded));
        Ok(())
    }
}

/// Adds what waits; the oldest makes room.
fn wait<H>(waiting: &mut VecDeque<(H, String)>, header: H, text: &[u8]) {
    if waiting.len() == MAX_WAITING {
        waiting.pop_front();
    }
    waiting.push_back((header, String::from_utf8_lossy(text).into_owned()));
}

/// A time that a message of ROS can say.
#[derive(Debug, Clone, Copy)]
struct Moment {
    ns: i64,
    stamp: Time,
}

impl Moment {
    fn of(ns: i64, topic: &'static str) -> Result<Self, TranscriptError> {
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
