//! Checks that the clocks of odometry and laser agree: scans are located on the map, and the motion
//! of the laser is compared with the odometry.

use engine::motion::Motion;
use geometry::Pose;
use offline::each_odometry;
use recording::{Kind, Recording};

use super::clock_offset::{Sighting, delay_s};
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
