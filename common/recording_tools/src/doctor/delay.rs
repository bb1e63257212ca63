//! Whether the clocks of odometry and laser agree: scans are located, and how the laser
//! moved is compared with what the odometry says.

use clap::Parser;
use engine::motion::{Motion, Sighting};
use geometry::Pose;
use offline::{Options, Session, each_odometry};
use recording::{Kind, Recording};

use super::finding::Finding;
use super::survey::{Seen, Survey};
use crate::RecordingToolsError;

/// Scans that are located at most: a minute of a laser of 8 Hz, seconds of computing.
const MAX_SCANS: usize = 500;

/// A difference is worth a note from here on, seconds: a robot that turns by a radian a
/// second is off by a degree then.
const WORTH_A_NOTE_S: f64 = 0.02;

/// How scans are taken: as they are, for the motion is what is asked for.
#[derive(Debug, Parser)]
struct Line {
    #[command(flatten)]
    options: Options,
}

/// Whether the odometry's stamps fit those of the scans.
pub(super) fn odometry_delay(recording: &Recording, survey: &Survey) -> Vec<Finding> {
    let scans = survey.of_kind(Kind::Scan).map(|(_, seen)| seen);
    let usual_period_s = scans
        .filter_map(Seen::usual_step_s)
        .fold(WORTH_A_NOTE_S, f64::max);
    let found = estimate(recording, usual_period_s).ok().flatten();
    let note = found.map(|delay_s| {
        let way = if delay_s > 0.0 {
            "leads"
        } else {
            "lags behind"
        };
        Finding::note(format!(
            "odometry {way} the laser by about {:.2} s: --odometry-delay-s={delay_s:.2} makes up \
             for it",
            delay_s.abs()
        ))
    });
    note.into_iter().collect()
}

/// What is to be added to the odometry's stamps, seconds, if the scans show it and it is
/// worth a note. A scan that does not say how long it takes may be stamped at its start or
/// at its end: from one scan to the next is then nothing unusual.
///
/// # Errors
/// The recording has no map, or cannot be read: that is said elsewhere.
fn estimate(
    recording: &Recording,
    usual_period_s: f64,
) -> Result<Option<f64>, RecordingToolsError> {
    let Some(topic) = recording.topic(Kind::Odometry)? else {
        return Ok(None);
    };
    let options = Line::parse_from(["doctor", "--deskew", "false"]).options;
    let mut session = Session::open(recording, &options, None)?;
    let mut sightings = Vec::new();
    let mut laser = None;
    let mut worth_a_note_s = WORTH_A_NOTE_S;
    for _ in 0..MAX_SCANS {
        let Some(scan) = session.scans.next() else {
            break;
        };
        let Ok(scan) = scan else {
            continue;
        };
        if scan.message.time_increment == 0.0 {
            worth_a_note_s = usual_period_s;
        }
        let reply = session.ask(&scan)?;
        let Ok(answer) = reply.answer else {
            continue;
        };
        // One in a wrong place is outvoted by the others.
        if let Some(best) = answer.places.places.first() {
            sightings.push(Sighting {
                at_ns: scan.stamp_ns,
                map_from_laser: best.map_from_laser,
            });
        }
        laser.get_or_insert((scan.frame().to_owned(), scan.base_from_laser));
    }
    let Some((frame, mount)) = laser else {
        return Ok(None);
    };
    let mut motion = Motion::keeping(usize::MAX);
    let mut child_from_laser = mount.unwrap_or_default();
    each_odometry(recording, &topic, |odometry| {
        if odometry.child_frame.as_str() == frame {
            child_from_laser = Pose::IDENTITY;
        }
        motion.add(odometry.stamp.measured_ns, odometry.odom_from_child.into());
    })?;
    let delay_s = motion.delay_s(&sightings, child_from_laser);
    Ok(delay_s.filter(|delay_s| delay_s.abs() >= worth_a_note_s))
}
