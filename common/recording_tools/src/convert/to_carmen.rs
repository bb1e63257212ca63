//! From a recording to a log.

use std::io::Write;

use geometry::Pose;
use recording::{Kind, Message, Recording, RecordingError};
use ros::LaserScan;
use transport::with_causes;

use super::carmen::{Odometry, Poses};
use super::report::Report;
use super::write::{self, Scan};
use crate::RecordingToolsError;

/// Writes the scans with the odometry and the mount that hold for each, and the
/// odometry itself. Messages that do not decode are counted, and a damaged recording
/// is written to the damage.
///
/// # Errors
/// The recording has no scans, or the log cannot be written.
pub(super) fn convert(
    recording: &Recording,
    log: &mut impl Write,
) -> Result<Report, RecordingToolsError> {
    let scans = recording.required_topic(Kind::Scan)?;
    let odometry = recording.topic(Kind::Odometry)?;
    let mut report = Report::default();
    let mut odom_from_base = Pose::IDENTITY;
    let mut mounts = std::collections::BTreeMap::new();
    for record in recording.records_of(&[Kind::Scan, Kind::Odometry]) {
        let record = match record {
            Ok(record) => record,
            Err(error @ RecordingError::Message { .. }) => {
                report.refused += 1;
                report
                    .first_refusal
                    .get_or_insert_with(|| error.to_string());
                continue;
            }
            Err(error) => {
                report.damage = Some(with_causes(&error));
                break;
            }
        };
        let is = |topic: Option<&str>| topic == Some(&*record.topic);
        let line = match &record.message {
            Message::Scan(scan) if is(Some(&*scans)) => {
                let frame = &scan.header.frame_id;
                if !mounts.contains_key(frame) {
                    let mount = recording.base_from_laser(frame)?;
                    let pose = mount.map_or(Pose::IDENTITY, |mount| mount.base_from_laser);
                    mounts.insert(frame.clone(), pose);
                }
                let base_from_laser = mounts.get(frame).copied().unwrap_or_default();
                report.scans += 1;
                write::scan(&laser(scan, odom_from_base, base_from_laser))
            }
            Message::Odometry(message) if is(odometry.as_deref()) => {
                let Ok(pose) = message.pose.pose.planar() else {
                    report.refused += 1;
                    continue;
                };
                odom_from_base = pose;
                report.odometry += 1;
                let motion = message.twist.twist.planar();
                write::odometry(&Odometry {
                    robot: pose,
                    velocities: (motion.x, motion.yaw),
                    time_ns: message.header.stamp.as_ns(),
                })
            }
            _ => continue,
        };
        log.write_all(line.as_bytes())
            .map_err(RecordingToolsError::Log)?;
    }
    Ok(report)
}

fn laser(scan: &LaserScan, odom_from_base: Pose, base_from_laser: Pose) -> Scan {
    Scan {
        angle_min: scan.angle_min.into(),
        angle_increment: scan.angle_increment.into(),
        range_max_m: scan.range_max.into(),
        ranges: scan.ranges.clone(),
        poses: Poses {
            laser: odom_from_base.then(base_from_laser),
            robot: odom_from_base,
        },
        time_ns: scan.header.stamp.as_ns(),
    }
}
