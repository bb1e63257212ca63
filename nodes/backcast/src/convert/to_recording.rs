//! From a log to a recording.

use std::collections::BTreeSet;
use std::io::{BufRead, Seek, Write};

use recording::ros::{
    self, Header, LaserScan, PoseStamped, Quaternion, TfMessage, Time, Transform, TransformStamped,
    Twist, TwistWithCovariance, Vector3,
};
use recording::write::RecordingWriter;
use recording::{GROUND_TRUTH, Message, ODOM, SCAN, TF_STATIC};

use super::carmen::{self, Laser, Line, Odometry};
use super::command::{Report, Rules};
use crate::BackcastError;

/// Two mounts are the same if they differ by less: logs have six digits.
const SAME_MOUNT: f64 = 1e-3;

/// Writes what the lines say. Lines that are broken are counted, and the first
/// one is told.
///
/// # Errors
/// The log cannot be read, or the recording not written.
pub(super) fn convert<W: Write + Seek>(
    log: impl BufRead,
    rules: &Rules,
    writer: &mut RecordingWriter<W>,
) -> Result<Report, BackcastError> {
    let mut conversion = Conversion {
        rules,
        writer,
        mounts: Vec::new(),
        odometry_ns: BTreeSet::new(),
        report: Report::default(),
    };
    for (number, line) in (1u64..).zip(log.split(b'\n')) {
        let line = line.map_err(BackcastError::Log)?;
        // Logs are ASCII; what is not is in comments and names of hosts.
        match carmen::parse(&String::from_utf8_lossy(&line)) {
            Ok(Some(Line::Laser(laser))) => conversion.laser(&laser, number)?,
            Ok(Some(Line::Odometry(odometry))) => conversion.odometry(&odometry, number)?,
            Ok(None) => conversion.report.left_out += 1,
            Err(reason) => conversion.refuse(number, &reason),
        }
    }
    Ok(conversion.report)
}

struct Conversion<'a, W: Write + Seek> {
    rules: &'a Rules,
    writer: &'a mut RecordingWriter<W>,
    /// Where each laser sits on the robot, by its frame.
    mounts: Vec<(String, geometry::Pose)>,
    /// Stamps of odometry that stands in the recording.
    odometry_ns: BTreeSet<i64>,
    report: Report,
}

impl<W: Write + Seek> Conversion<'_, W> {
    fn laser(&mut self, laser: &Laser, number: u64) -> Result<(), BackcastError> {
        let Some((ns, stamp)) = moment(laser.time_ns) else {
            self.refuse(number, &format!("a time of {} ns", laser.time_ns));
            return Ok(());
        };
        let (topic, frame) = match laser.name.as_str() {
            "RLASER" | "ROBOTLASER2" => ("/scan_rear", "laser_rear"),
            _ => (SCAN, "laser"),
        };
        if self.rules.truth {
            let pose = ros::Pose::from_planar(laser.laser);
            let truth = PoseStamped {
                header: header(stamp, "map"),
                pose,
            };
            if topic == SCAN {
                self.write(GROUND_TRUTH, ns, &Message::PoseStamped(truth))?;
            }
        } else {
            self.mount(ns, frame, laser.robot.inverse().then(laser.laser), stamp)?;
        }
        self.odometry_at(ns, stamp, laser.robot, (0.0, 0.0))?;
        let message = scan(laser, stamp, frame, self.rules.range_max_m);
        self.report.scans += 1;
        self.write(topic, ns, &Message::Scan(message))
    }

    fn odometry(&mut self, odometry: &Odometry, number: u64) -> Result<(), BackcastError> {
        match moment(odometry.time_ns) {
            Some((ns, stamp)) => self.odometry_at(ns, stamp, odometry.robot, odometry.velocities),
            None => {
                self.refuse(number, &format!("a time of {} ns", odometry.time_ns));
                Ok(())
            }
        }
    }

    fn odometry_at(
        &mut self,
        ns: i64,
        stamp: Time,
        robot: geometry::Pose,
        (forward, turn): (f64, f64),
    ) -> Result<(), BackcastError> {
        if !self.odometry_ns.insert(ns) {
            return Ok(());
        }
        let motion = geometry::Pose::new(forward, 0.0, turn);
        let message = ros::Odometry {
            header: header(stamp, "odom"),
            child_frame_id: "base_link".to_owned(),
            pose: ros::PoseWithCovariance::from_planar(robot, [0.0; 9]),
            twist: TwistWithCovariance {
                twist: Twist::from_planar(motion),
                ..TwistWithCovariance::default()
            },
        };
        self.report.odometry += 1;
        self.write(ODOM, ns, &Message::Odometry(Box::new(message)))
    }

    /// Notes where a laser sits, by the first line that tells.
    fn mount(
        &mut self,
        ns: i64,
        frame: &str,
        base_from_laser: geometry::Pose,
        stamp: Time,
    ) -> Result<(), BackcastError> {
        let known = self.mounts.iter().find(|(other, _)| other == frame);
        if let Some((_, known)) = known {
            if !known.is_within(base_from_laser, SAME_MOUNT, SAME_MOUNT) {
                self.report.moved_mounts += 1;
            }
            return Ok(());
        }
        self.mounts.push((frame.to_owned(), base_from_laser));
        let transform = |(frame, pose): &(String, geometry::Pose)| TransformStamped {
            header: header(stamp, "base_link"),
            child_frame_id: frame.clone(),
            transform: Transform {
                translation: Vector3 {
                    x: pose.x,
                    y: pose.y,
                    z: 0.0,
                },
                rotation: Quaternion::from_yaw(pose.yaw),
            },
        };
        let transforms = self.mounts.iter().map(transform).collect();
        self.write(
            TF_STATIC,
            ns,
            &Message::StaticTransforms(TfMessage { transforms }),
        )
    }

    fn write(&mut self, topic: &str, ns: i64, message: &Message) -> Result<(), BackcastError> {
        Ok(self.writer.write(topic, ns, message)?)
    }

    fn refuse(&mut self, number: u64, reason: &str) {
        self.report.refused += 1;
        self.report
            .first_refusal
            .get_or_insert_with(|| format!("line {number}: {reason}"));
    }
}

fn scan(laser: &Laser, stamp: Time, frame: &str, range_max_m: f32) -> LaserScan {
    let steps = laser.ranges.len().saturating_sub(1) as f64;
    let range_max = laser.range_max_m.map_or(range_max_m, |range| range as f32);
    LaserScan {
        header: header(stamp, frame),
        angle_min: laser.angle_min as f32,
        angle_max: (laser.angle_min + steps * laser.angle_increment) as f32,
        angle_increment: laser.angle_increment as f32,
        range_min: 0.0,
        range_max,
        ranges: laser.ranges.clone(),
        ..LaserScan::default()
    }
}

fn header(stamp: Time, frame: &str) -> Header {
    Header {
        stamp,
        frame_id: frame.to_owned(),
    }
}

/// A time, if a recording can say it.
fn moment(ns: i64) -> Option<(i64, Time)> {
    Some((ns, Time::from_ns(ns)?))
}

#[cfg(test)]
mod tests {
    use recording::write::Packing;
    use recording::{Kind, Recording};

    use super::*;

    const LOG: &str = "# a log
PARAM laser_front_laser_resolution 0.5 ipc 0 h 0
ODOM 0 0 0 0.25 0 0 0.5 h 0.5
FLASER 3 1.0 81.83 2.5 0.5 0 0 0 0 0 1.0 h 1.0
FLASER 3 1.0 broken
FLASER 3 2.0 81.83 2.5 1.5 0 0 1 0 0 2.0 h 2.0
";

    fn converted(rules: &Rules) -> (Recording, Report) {
        let mut writer = RecordingWriter::in_memory(Packing::Zstd).unwrap();
        let report = convert(LOG.as_bytes(), rules, &mut writer).unwrap();
        let bytes = writer.finish().unwrap().into_inner();
        (Recording::from_bytes("r.mcap", bytes).unwrap(), report)
    }

    #[test]
    fn scans_odometry_and_the_mount_are_found() {
        let rules = Rules {
            truth: false,
            range_max_m: 80.0,
        };
        let (recording, report) = converted(&rules);
        assert_eq!((report.scans, report.odometry, report.refused), (2, 3, 1));
        assert_eq!((report.left_out, report.moved_mounts), (2, 0));
        let refusal = report.first_refusal.unwrap();
        assert!(
            refusal.starts_with("line 5: \"broken\" is none"),
            "{refusal}"
        );
        let mount = recording.base_from_laser("laser").unwrap().unwrap();
        assert_eq!(mount.base_from_laser, geometry::Pose::new(0.5, 0.0, 0.0));
        let Message::Scan(scan) = recording
            .records_of(&[Kind::Scan])
            .next()
            .unwrap()
            .unwrap()
            .message
        else {
            panic!("asked for scans");
        };
        assert_eq!(
            (scan.ranges[1], scan.range_max, scan.header.stamp.sec),
            (81.83, 80.0, 1)
        );
    }

    #[test]
    fn corrected_poses_become_the_truth() {
        let rules = Rules {
            truth: true,
            range_max_m: 80.0,
        };
        let (recording, _) = converted(&rules);
        let truths = recording.ground_truths().unwrap();
        assert_eq!(truths.len(), 2);
        assert_eq!(truths[&2_000_000_000].pose.x, 1.5);
        assert_eq!(recording.base_from_laser("laser").unwrap(), None);
    }
}
