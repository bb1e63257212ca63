//! A drive in memory, before the search. Variants change a copy of it.

use std::collections::BTreeSet;

use ::map::OccupancyGrid;
use geometry::Pose;
use messages::Odometry;
use offline::{Accepted, Progress, Session, TakenScan, each_odometry};
use rand::rngs::Xoshiro256PlusPlus;
use recording::{Kind, Recording};

use super::super::drive::{self, Moment};
use crate::truths::Truths;

/// Random numbers and another map for a change.
pub(super) struct Means<'a> {
    pub(super) rng: Xoshiro256PlusPlus,
    pub(super) other_map: Option<&'a OccupancyGrid>,
}

/// Result of a change; the error is the reason why the variant does not apply to a drive.
pub(super) type Change<T> = Result<T, &'static str>;

/// A map, and all measurements of a drive on it.
#[derive(Clone)]
pub(super) struct Material {
    pub(super) map: OccupancyGrid,
    pub(super) steps: Vec<Step>,
    pub(super) odometry: Vec<Odometry>,
    /// True if no pose is right.
    pub(super) is_nowhere: bool,
    /// Starts are within this distance from the beginning of the drive, in metres.
    pub(super) starts_until_m: f64,
}

#[derive(Clone)]
pub(super) struct Step {
    pub(super) scan: TakenScan,
    pub(super) truth: Option<Pose>,
    /// The truth, interpolated where it is not known.
    pub(super) map_from_laser: Pose,
    /// Distance travelled so far, in metres.
    pub(super) gone_m: f64,
}

impl Material {
    pub(super) fn read(
        recording: &Recording,
        session: &mut Session<'_>,
        map: OccupancyGrid,
        (truths, ignored): (&Truths, &BTreeSet<u64>),
    ) -> anyhow::Result<Self> {
        let mut odometry = Vec::new();
        // Like a session, uses no odometry if several channels could be it.
        if let Ok(Some(topic)) = recording.topic(Kind::Odometry) {
            each_odometry(recording, &topic, |one| odometry.push(*one))?;
        }
        let mut steps = Vec::new();
        for (number, scan) in (0..).zip(session.scans.by_ref()) {
            let scan = scan?;
            let truth = truths.at(scan.stamp_ns);
            steps.push(Step {
                truth: truth.filter(|_| !ignored.contains(&number)),
                map_from_laser: truths.guess(scan.stamp_ns),
                gone_m: 0.0,
                scan,
            });
        }
        Ok(Material {
            map,
            steps,
            odometry,
            is_nowhere: false,
            starts_until_m: f64::INFINITY,
        })
    }

    pub(super) fn search(
        &self,
        session: &mut Session<'_>,
        (progress, accepted): (&Progress, &mut Accepted),
    ) -> anyhow::Result<Vec<Moment>> {
        session.begin_again(&self.odometry);
        let mut moments = Vec::with_capacity(self.steps.len());
        for step in &self.steps {
            let moment = drive::search(session, &step.scan, step.truth, accepted)?;
            moments.extend(moment.map(|moment| Moment {
                gone_m: step.gone_m,
                is_nowhere: self.is_nowhere,
                ..moment
            }));
            for note in session.take_notes() {
                progress.say(&note);
            }
            progress.step();
        }
        drive::connect(&mut moments, (false, 1.0));
        Ok(moments)
    }

    /// Copies of moments with their search results, and with this odometry.
    pub(super) fn with_odometry(
        &self,
        session: &mut Session<'_>,
        moments: &[Moment],
    ) -> anyhow::Result<Vec<Moment>> {
        session.begin_again(&self.odometry);
        let mut moments = moments.to_vec();
        let mut left = moments.iter_mut().peekable();
        for step in &self.steps {
            let by_odometry = session.by_odometry(&step.scan)?;
            // A rejected scan has no moment.
            if let Some(moment) = left.next_if(|moment| moment.stamp_ns == step.scan.stamp_ns) {
                moment.by_odometry = by_odometry;
            }
        }
        drive::connect(&mut moments, (false, 1.0));
        Ok(moments)
    }

    /// Fills in the distance travelled at each scan.
    pub(super) fn measure(&mut self, moments: &[Moment]) {
        for step in &mut self.steps {
            let stamp_ns = step.scan.stamp_ns;
            let after = moments.partition_point(|moment| moment.stamp_ns <= stamp_ns);
            step.gone_m = after.checked_sub(1).map_or(0.0, |i| moments[i].gone_m);
        }
    }

    /// Distance travelled from the first scan to the last, in metres.
    pub(super) fn length_m(&self) -> f64 {
        self.steps.last().map_or(0.0, |last| last.gone_m)
    }
}
