//! A drive: everything the tracker takes of its scans, read and searched once.

use std::collections::{BTreeMap, BTreeSet};

use engine::fit::Ends;
use engine::joined::ByOdometry;
use engine::peaks::Target;
use engine::tracking::Candidate;
use geometry::{Pose, wrap_angle};
use offline::{Accepted, Session, View};
use progress::Progress;
use recording::GroundTruth;

use super::SequenceOptions;
use crate::EvaluationError;

/// One scan of a drive.
pub(super) struct Moment {
    pub(super) stamp_ns: i64,
    /// The first laser's true pose in the map, if that is known.
    pub(super) truth: Option<Pose>,
    pub(super) view: View,
    /// How the target frame moved since the moment before.
    pub(super) moved: Option<Pose>,
    /// Metres along the drive until here.
    pub(super) gone_m: f64,
    /// What a search finds.
    pub(super) found: Vec<Candidate>,
    /// Milliseconds of computing that the search took.
    pub(super) search_ms: f64,
}

impl Moment {
    pub(super) fn ends(&self) -> &Ends {
        &self.view.ends
    }

    /// The pose of the first laser where the tracker has the target frame.
    pub(super) fn laser(&self, map_from_target: Pose) -> Pose {
        self.view.target.laser(map_from_target)
    }
}

/// Searches all scans of a recording.
///
/// # Errors
/// The recording cannot be read, or holds no scan that can be used.
pub(super) fn read(
    session: &mut Session<'_>,
    truths: &BTreeMap<i64, GroundTruth>,
    options: &SequenceOptions,
    (progress, accepted): (&Progress, &mut Accepted),
) -> Result<Vec<Moment>, EvaluationError> {
    session.read_odometry()?;
    let ignored: BTreeSet<u64> = options.ignore_truth.iter().copied().collect();
    let mut moments: Vec<Moment> = Vec::new();
    let mut number = 0;
    while let Some(scan) = session.scans.next() {
        let scan = scan?;
        let reply = session.ask(&scan)?;
        accepted.count(&reply);
        let (map_id, search_ms) = (reply.map_id, reply.cpu_ms);
        let hypotheses = reply.answer.map(|answer| {
            let target = |place: &engine::peaks::Place| place.hypothesis(map_id, of_laser());
            answer.places.places.iter().map(target).collect::<Vec<_>>()
        });
        for note in session.take_notes() {
            progress.say(&note);
        }
        progress.step();
        let truth = truths.get(&scan.stamp_ns).map(|truth| truth.pose);
        let truth = truth.filter(|_| !ignored.contains(&number));
        number += 1;
        let Ok(hypotheses) = hypotheses else { continue };
        let view = session.view(&scan)?;
        let mut found = Vec::new();
        Candidate::fill(
            &mut found,
            hypotheses.iter().map(|found| (0, found)),
            view.target,
        );
        moments.push(Moment {
            stamp_ns: scan.stamp_ns,
            truth,
            found,
            search_ms,
            moved: None,
            gone_m: 0.0,
            view,
        });
    }
    connect(&mut moments, options);
    Ok(moments)
}

/// Places of the first laser stay what they are; as messages, scores have 32 bits, as in
/// the graph.
fn of_laser() -> Target {
    Target::of(None, false)
}

/// Fills in how the moments follow each other.
fn connect(moments: &mut [Moment], options: &SequenceOptions) {
    for i in 1..moments.len() {
        let (before, now) = (&moments[i - 1], &moments[i]);
        let by_odometry = ByOdometry::between(before.view.by_odometry, now.view.by_odometry);
        let truly = before.truth.zip(now.truth).map(|(a, b)| {
            let target = |laser| now.view.target.from_laser(laser);
            target(a).inverse().then(target(b))
        });
        let step = by_odometry
            .or(truly)
            .map_or(0.0, |step| step.x.hypot(step.y));
        let moved = by_odometry.filter(|_| !options.without_odometry);
        let moved = moved.map(|step| worsened(step, truly, options.odometry_noise));
        let gone_m = before.gone_m + step;
        (moments[i].moved, moments[i].gone_m) = (moved, gone_m);
    }
}

/// A step whose error is this many times as large.
fn worsened(step: Pose, truly: Option<Pose>, factor: f64) -> Pose {
    let Some(truly) = truly else { return step };
    if factor == 1.0 {
        return step;
    }
    Pose::new(
        truly.x + factor * (step.x - truly.x),
        truly.y + factor * (step.y - truly.y),
        truly.yaw + factor * wrap_angle(step.yaw - truly.yaw),
    )
}
