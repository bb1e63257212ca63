//! A drive: all inputs of the tracker, read and searched once.

use std::collections::BTreeSet;
use std::sync::Arc;

use engine::fit::Ends;
use engine::joined::ByOdometry;
use engine::peaks::Target;
use engine::tracking::Candidate;
use geometry::{Pose, wrap_angle};
use offline::{Accepted, Progress, Session, TakenScan, View};

use crate::truths::Truths;

/// One scan of a drive. Copies share the view and the search results.
#[derive(Clone)]
pub(super) struct Moment {
    pub(super) stamp_ns: i64,
    /// True pose of the first laser in the map, if known.
    pub(super) truth: Option<Pose>,
    /// True if no pose is right, as on another building's map.
    pub(super) is_nowhere: bool,
    pub(super) view: Arc<View>,
    pub(super) by_odometry: Option<ByOdometry>,
    /// Motion of the target frame since the previous moment.
    pub(super) moved: Option<Pose>,
    /// Distance travelled so far, in metres.
    pub(super) gone_m: f64,
    pub(super) found: Arc<[Candidate]>,
    /// CPU time of the search, in milliseconds.
    pub(super) search_ms: f64,
}

impl Moment {
    pub(super) fn ends(&self) -> &Ends {
        &self.view.ends
    }

    /// Converts a pose of the tracker's target frame to one of the first laser.
    pub(super) fn laser(&self, map_from_target: Pose) -> Pose {
        self.view.target.laser(map_from_target)
    }

    /// Metres and degrees from the truth, if known.
    pub(super) fn off(&self, pose: Pose) -> Option<(f64, f64)> {
        if self.is_nowhere {
            return Some((f64::INFINITY, 180.0));
        }
        let truth = self.truth?;
        Some((pose.distance_to(truth), pose.angle_to(truth).to_degrees()))
    }
}

pub(super) fn read(
    session: &mut Session<'_>,
    truths: &Truths,
    (ignore_truth, errors): (&[u64], (bool, f64)),
    (progress, accepted): (&Progress, &mut Accepted),
) -> anyhow::Result<Vec<Moment>> {
    session.read_odometry()?;
    let ignored: BTreeSet<u64> = ignore_truth.iter().copied().collect();
    let mut moments: Vec<Moment> = Vec::new();
    let mut number = 0;
    while let Some(scan) = session.scans.next() {
        let scan = scan?;
        let truth = truths.at(scan.stamp_ns);
        let truth = truth.filter(|_| !ignored.contains(&number));
        number += 1;
        moments.extend(search(session, &scan, truth, accepted)?);
        for note in session.take_notes() {
            progress.say(&note);
        }
        progress.step();
    }
    connect(&mut moments, errors);
    measure(&mut moments);
    Ok(moments)
}

/// Searches one scan; `None` if it is rejected.
pub(super) fn search(
    session: &mut Session<'_>,
    scan: &TakenScan,
    truth: Option<Pose>,
    accepted: &mut Accepted,
) -> anyhow::Result<Option<Moment>> {
    let reply = session.ask(scan)?;
    accepted.count(&reply);
    let search_ms = reply.cpu_ms;
    let Ok(places) = reply.answer.map(|answer| answer.places.clone()) else {
        return Ok(None);
    };
    let view = session.view(scan)?;
    // Places of a session are poses of the first laser, as in the graph.
    let laser = Target::of(None, false);
    Ok(Some(Moment {
        stamp_ns: scan.stamp_ns,
        truth,
        is_nowhere: false,
        found: Candidate::of_places(&places, laser, view.target).into(),
        search_ms,
        by_odometry: view.by_odometry,
        moved: None,
        gone_m: 0.0,
        view: Arc::new(view),
    }))
}

/// Fills in the motion between moments, from odometry with its error scaled by `noise`.
pub(super) fn connect(moments: &mut [Moment], (without_odometry, noise): (bool, f64)) {
    for i in 1..moments.len() {
        let (by_odometry, truly) = steps(&moments[i - 1], &moments[i]);
        let moved = by_odometry.filter(|_| !without_odometry);
        moments[i].moved = moved.map(|step| worsened(step, truly, noise));
    }
}

/// Fills in the distance travelled, from odometry or else from the truth.
pub(super) fn measure(moments: &mut [Moment]) {
    for i in 1..moments.len() {
        let (by_odometry, truly) = steps(&moments[i - 1], &moments[i]);
        let step = by_odometry.or(truly);
        let gone = step.map_or(0.0, |step| step.x.hypot(step.y));
        moments[i].gone_m = moments[i - 1].gone_m + gone;
    }
}

/// Motion between two moments, by odometry and by the truth.
fn steps(before: &Moment, now: &Moment) -> (Option<Pose>, Option<Pose>) {
    let truly = before.truth.zip(now.truth).map(|(a, b)| {
        let target = |laser| now.view.target.from_laser(laser);
        target(a).inverse().then(target(b))
    });
    let by_odometry = ByOdometry::between(before.by_odometry, now.by_odometry);
    (by_odometry, truly)
}

/// Returns the step with its error multiplied by `factor`.
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
