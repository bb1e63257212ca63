//! Runs the tracker over moments of a drive.

use engine::tracking::{Candidate, Need, PlaceTracker, Report, Seen, TrackingConfig};
use geometry::{Covariance, Pose};
use messages::TrackState;
use offline::{World, cpu};

use super::drive::Moment;
use crate::trust::Trust;

pub(super) struct Run<'a> {
    world: &'a World,
    moments: &'a [Moment],
    tracker: PlaceTracker,
    /// Moment whose search result is delivered at a later scan.
    asked: Option<usize>,
    /// CPU time of each scan that was tracked without a search, in milliseconds.
    pub(super) tracking_ms: Vec<f64>,
    pub(super) searches: u64,
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Said {
    pub(super) report: Report,
    /// Pose of the first laser, if known.
    pub(super) pose: Option<Pose>,
    /// Metres and degrees from the truth, if both are known.
    pub(super) off: Option<(f64, f64)>,
}

/// Counts of the scans with a known truth.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct Tally {
    pub(super) scans: u64,
    /// Scans that were Unique, and Unique and wrong.
    pub(super) unique: u64,
    pub(super) wrong: u64,
    pub(super) trust: Trust,
}

impl Tally {
    pub(super) fn add(&mut self, moment: &Moment, said: &Said) {
        let is_judged = moment.is_nowhere || moment.truth.is_some();
        self.scans += u64::from(is_judged);
        self.unique += u64::from(is_judged && said.is_unique());
        self.wrong += u64::from(said.is_wrong());
        if said.off.is_some() {
            self.trust.add(said.report.probability, !said.is_off());
        }
    }

    pub(super) fn with(mut self, other: &Self) -> Self {
        self.scans += other.scans;
        self.unique += other.unique;
        self.wrong += other.wrong;
        self.trust.merge(&other.trust);
        self
    }
}

/// Limits in metres and degrees: an error above `WRONG` is wrong, one up to `RIGHT` is right.
pub(crate) const WRONG: (f64, f64) = (1.0, 25.0);
pub(super) const RIGHT: (f64, f64) = answers::statistics::SUCCESS;

impl Said {
    pub(super) fn is_unique(&self) -> bool {
        self.report.state == TrackState::Unique
    }

    /// True if Unique and right.
    pub(super) fn is_right(&self) -> bool {
        self.is_unique()
            && self
                .off
                .is_some_and(|(m, deg)| m <= RIGHT.0 && deg <= RIGHT.1)
    }

    /// True if Unique and wrong.
    pub(super) fn is_wrong(&self) -> bool {
        self.is_unique() && self.is_off()
    }

    pub(super) fn is_off(&self) -> bool {
        self.off
            .is_some_and(|(m, deg)| m > WRONG.0 || deg > WRONG.1)
    }
}

impl<'a> Run<'a> {
    pub(super) fn new(world: &'a World, moments: &'a [Moment], config: TrackingConfig) -> Self {
        Run {
            world,
            moments,
            tracker: PlaceTracker::new(config),
            asked: None,
            tracking_ms: Vec::new(),
            searches: 0,
        }
    }

    fn seen(&self, moment: &'a Moment) -> Seen<'a> {
        Seen {
            distance_field: self.world.distance_field(),
            ends: moment.ends(),
            fit: &self.world.peaks().fit,
        }
    }

    /// Starts the tracker at the truth of a moment.
    pub(super) fn start_at(&mut self, index: usize, truth: Pose) {
        let moment = &self.moments[index];
        let seen = self.seen(moment);
        // Typical error of the available truths.
        let covariance = Covariance::from_deviations(0.05, 0.05, 1f64.to_radians());
        let pose = moment.view.target.from_laser(truth);
        self.asked = None;
        self.tracker.start_at(&[seen], (0, pose), covariance);
    }

    /// Follows the robot from a truth `metres` before a moment; true if the tracker is right there.
    pub(super) fn follow_to(&mut self, last: usize, metres: f64) -> anyhow::Result<bool> {
        let moments = self.moments;
        let begin = moments.partition_point(|m| m.gone_m < moments[last].gone_m - metres);
        let known = (begin..last).find_map(|i| Some((i, moments[i].truth?)));
        let Some((first, truth)) = known else {
            return Ok(false);
        };
        self.start_at(first, truth);
        let mut is_right = false;
        let since = moments.iter().enumerate().take(last + 1).skip(first + 1);
        for (index, moment) in since {
            is_right = self.take(index, moment.moved)?.is_right();
        }
        Ok(is_right)
    }

    /// Passes a moment to the tracker, with the motion since the previous one.
    pub(super) fn take(&mut self, index: usize, moved: Option<Pose>) -> anyhow::Result<Said> {
        let moment = &self.moments[index];
        let seen = self.seen(moment);
        let (tracker, asked, moments) = (&mut self.tracker, &mut self.asked, self.moments);
        let (need, cost_ms) = cpu::timed(|| {
            let need = tracker.begin(&[seen], moment.stamp_ns, moved);
            let found: Option<&[Candidate]> = match need {
                Need::Nothing => None,
                Need::ThisScan => Some(&moment.found),
                Need::EarlierScan => asked.take().map(|asked| &moments[asked].found[..]),
            };
            tracker.finish(&[seen], found);
            need
        })?;
        if tracker.asks_ahead() {
            *asked = Some(index);
        }
        match need {
            Need::Nothing => self.tracking_ms.push(cost_ms),
            Need::ThisScan | Need::EarlierScan => self.searches += 1,
        }
        let report = self.tracker.report();
        let pose = report.pose.map(|pose| moment.laser(pose));
        let off = pose.and_then(|pose| moment.off(pose));
        Ok(Said { report, pose, off })
    }
}
