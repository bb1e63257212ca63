//! Checks that the clocks of odometry and laser agree: scans are located on the map, and the motion
//! of the laser is compared with the odometry.

use engine::motion::Motion;
use geometry::Pose;
use offline::each_odometry;
use recording::{Kind, Recording};

use super::finding::Finding;
use super::located::{Located, LocatedScan};
use super::survey::{Seen, Survey};

/// Smallest delay that is worth a note, in seconds: a robot that turns by a radian per second is
/// then off by a degree.
const WORTH_A_NOTE_S: f64 = 0.02;

pub(super) fn odometry_delay(
    recording: &Recording,
    survey: &Survey,
    located: &Located,
) -> Option<Finding> {
    let scans = survey.of_kind(Kind::Scan).map(|(_, seen)| seen);
    let usual_period_s = scans
        .filter_map(Seen::usual_step_s)
        .fold(WORTH_A_NOTE_S, f64::max);
    // Other checks report a recording that cannot be read.
    let delay_s = estimate(recording, located, usual_period_s).ok()??;
    let way = match delay_s > 0.0 {
        true => "leads",
        false => "lags behind",
    };
    Some(Finding::note(format!(
        "odometry {way} the laser by about {:.2} s: --odometry-delay-s={delay_s:.2} makes up for it",
        delay_s.abs()
    )))
}

/// Estimates the time to add to the odometry's stamps, in seconds; `None` if the scans do not show
/// it or it is too small for a note. A scan without a time increment may be stamped at its start or
/// its end, so that a delay of one scan period is nothing unusual.
fn estimate(
    recording: &Recording,
    located: &Located,
    usual_period_s: f64,
) -> anyhow::Result<Option<f64>> {
    let Some(topic) = recording.topic(Kind::Odometry)? else {
        return Ok(None);
    };
    let Some(first) = located.scans.first() else {
        return Ok(None);
    };
    let (frame, mount) = (first.scan.frame(), first.scan.base_from_laser);
    let is_timed = |found: &LocatedScan| found.scan.message.time_increment != 0.0;
    let worth_a_note_s = match located.scans.iter().all(is_timed) {
        true => WORTH_A_NOTE_S,
        false => usual_period_s,
    };
    // A scan at a wrong place is outvoted by the others.
    let sightings = located.scans.iter().map(|found| Sighting {
        at_ns: found.scan.stamp_ns,
        map_from_laser: found.map_from_laser,
    });
    let sightings: Vec<Sighting> = sightings.collect();
    let mut motion = Motion::keeping(usize::MAX);
    let mut child_from_laser = mount.unwrap_or_default();
    each_odometry(recording, &topic, |odometry| {
        if odometry.child_frame.as_str() == frame {
            child_from_laser = Pose::IDENTITY;
        }
        motion.add(odometry.stamp.measured_ns, odometry.odom_from_child.into());
    })?;
    let delay_s = delay_s(&motion, &sightings, child_from_laser);
    Ok(delay_s.filter(|delay_s| delay_s.abs() >= worth_a_note_s))
}

#[derive(Debug, Clone, Copy, PartialEq)]
struct Sighting {
    /// Stamp of the scan, with which its pose is published, in nanoseconds.
    at_ns: i64,
    map_from_laser: Pose,
}

/// Largest delay that is tried to either side, and the step between delays, in seconds.
const MAX_DELAY_S: f64 = 0.5;
const STEP_S: f64 = 0.005;

/// Time between two sightings that are compared, in nanoseconds: below it the noise of the poses
/// hides the motion, above it odometry drifts.
const GAP_NS: std::ops::RangeInclusive<i64> = 450_000_000..=1_000_000_000;

/// Smallest number of pairs of sightings that can distinguish a delay from chance.
const MIN_PAIRS: usize = 20;

/// Cap on the difference of a pair, in metres, so that a pose at a wrong place does not decide.
const MAX_DIFFERENCE_M: f64 = 0.2;

/// Largest ratio of the best delay's squared differences to the mean over all delays. A robot that
/// never accelerates or turns shows no delay.
const MAX_REST: f64 = 0.5;

/// Returns the offset, in seconds, to add to the stamps of odometry so that it moves as the
/// sightings do: positive if odometry leads the laser. `None` if they do not show it.
///
/// The motion between sightings half a second apart is compared with that of odometry at the
/// same times, shifted by each delay; a radian counts as a metre.
fn delay_s(motion: &Motion, sightings: &[Sighting], child_from_laser: Pose) -> Option<f64> {
    let steps = (MAX_DELAY_S / STEP_S).round() as i32;
    let pairs: Vec<[Sighting; 2]> = sightings
        .iter()
        .enumerate()
        .filter_map(|(i, first)| {
            let after = sightings.get(i + 1..)?.iter();
            let gap_ns = |second: &Sighting| second.at_ns.saturating_sub(first.at_ns);
            let second = after
                .copied()
                .find(|second| GAP_NS.contains(&gap_ns(second)))?;
            Some([*first, second])
        })
        .filter(|pair| covers(motion, pair, child_from_laser))
        .collect();
    if pairs.len() < MIN_PAIRS {
        return None;
    }
    let rest = |step: i32| {
        let delay_ns = (f64::from(step) * STEP_S * 1e9) as i64;
        let differences = pairs.iter().map(|pair| {
            let moved = between(motion, pair, delay_ns, child_from_laser);
            moved.map_or(MAX_DIFFERENCE_M.powi(2), |moved| difference(pair, moved))
        });
        differences.sum::<f64>()
    };
    let rests: Vec<f64> = (-steps..=steps).map(rest).collect();
    let (best, least) = rests
        .iter()
        .enumerate()
        .min_by(|(_, a), (_, b)| a.total_cmp(b))?;
    let mean = rests.iter().sum::<f64>() / rests.len() as f64;
    let is_inside = 0 < best && best + 1 < rests.len();
    if !is_inside || *least > MAX_REST * mean {
        return None;
    }
    // Minimum of the parabola through the best delay and its neighbours.
    let (before, after) = (rests[best - 1], rests[best + 1]);
    let curvature = before - 2.0 * least + after;
    let off = if curvature > 0.0 {
        0.5 * (before - after) / curvature
    } else {
        0.0
    };
    Some((best as f64 + off - f64::from(steps)) * STEP_S)
}

fn covers(motion: &Motion, pair: &[Sighting; 2], child_from_laser: Pose) -> bool {
    let most_ns = (MAX_DELAY_S * 1e9) as i64;
    [-most_ns, most_ns]
        .into_iter()
        .all(|delay_ns| between(motion, pair, delay_ns, child_from_laser).is_some())
}

fn between(
    motion: &Motion,
    pair: &[Sighting; 2],
    delay_ns: i64,
    child_from_laser: Pose,
) -> Option<Pose> {
    let laser_at = |at_ns: i64| -> Option<Pose> {
        let located = motion.at(at_ns.saturating_sub(delay_ns))?;
        Some(located.odom_from_child.then(child_from_laser))
    };
    let before = laser_at(pair[0].at_ns)?;
    Some(before.inverse().then(laser_at(pair[1].at_ns)?))
}

/// Difference between the motion from a pair of sightings and another one, in squared metres.
fn difference(pair: &[Sighting; 2], moved: Pose) -> f64 {
    let seen = pair[0]
        .map_from_laser
        .inverse()
        .then(pair[1].map_from_laser);
    let angle = seen.angle_to(moved);
    let metres = seen.distance_to(moved).hypot(angle);
    metres.min(MAX_DIFFERENCE_M).powi(2)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Pose of a robot that swings to both sides while it drives.
    fn at(seconds: f64) -> Pose {
        Pose::new(0.5 * seconds, 0.0, 0.4 * (1.5 * seconds).sin())
    }

    fn ns(seconds: f64) -> i64 {
        (seconds * 1e9) as i64
    }

    fn found(truth: impl Fn(f64) -> Pose, lead_s: f64) -> Option<f64> {
        let mut motion = Motion::keeping(usize::MAX);
        for i in 0..600 {
            let seconds = f64::from(i) * 0.02;
            // Odometry shows now what the laser sees later.
            motion.add(ns(seconds), truth(seconds + lead_s));
        }
        let mount = Pose::new(0.3, 0.0, 0.5);
        let sightings: Vec<Sighting> = (10..110)
            .map(|i| f64::from(i) * 0.1)
            .map(|seconds| Sighting {
                at_ns: ns(seconds),
                map_from_laser: Pose::new(3.0, 1.0, 2.0).then(truth(seconds)).then(mount),
            })
            .collect();
        delay_s(&motion, &sightings, mount)
    }

    #[test]
    fn a_lead_and_a_lag_are_reported() {
        for lead_s in [0.13, 0.0, -0.2] {
            let found = found(at, lead_s).unwrap();
            // The parabola is fitted through steps of 5 ms to a curve that is nearly one.
            assert!((found - lead_s).abs() < 0.002, "{found} is not {lead_s}");
        }
    }

    #[test]
    fn a_robot_that_never_turns_shows_nothing() {
        assert_eq!(
            found(|seconds| Pose::new(0.5 * seconds, 0.0, 0.0), 0.1),
            None
        );
    }
}
