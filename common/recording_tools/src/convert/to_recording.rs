//! Converts a log to a recording.

use std::collections::BTreeSet;
use std::io::{BufRead, Seek, Write};

use recording::write::RecordingWriter;
use recording::{GROUND_TRUTH, Message, ODOM, SCAN, TF_STATIC};
use ros::{Time, Transform};
use transport::with_causes;

use super::angles;
use super::carmen::{Broken, Laser, Line, Odometry};
use super::file::for_each_line;
use super::lasers::{Source, Survey};
use super::read;
use super::report::Report;
use crate::messages;

/// Largest difference of two equal mounts, in metres and radians: logs have six digits.
const SAME_MOUNT: f64 = 1e-3;

#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Rules {
    pub(super) truth: bool,
    pub(super) range_max_m: f32,
}

/// Converts a log. Lines that cannot be read are counted.
pub(super) fn convert<W: Write + Seek>(
    log: impl BufRead,
    rules: &Rules,
    writer: &mut RecordingWriter<W>,
) -> anyhow::Result<Report> {
    let (mut survey, mut report) = (Survey::default(), Report::default());
    let mut measurements = Vec::new();
    let read = for_each_line(log, |number, line| match read::parse(line) {
        Ok(Line::Other(name)) => report.other(&name),
        Ok(line) => {
            survey.see(&line);
            if matches!(line, Line::Laser(_) | Line::Odometry(_)) {
                measurements.push((number, line));
            }
        }
        Err(broken) => report.broken(number, &broken),
    });
    report.damage = read.err().map(|error| with_causes(&error));
    let mut conversion = Conversion {
        rules,
        writer,
        sources: survey.sources(),
        survey: &survey,
        mounts: Vec::new(),
        odometry_ns: BTreeSet::new(),
        report,
    };
    for (number, line) in &measurements {
        let broken = match line {
            Line::Laser(laser) => conversion.laser(laser)?,
            Line::Odometry(odometry) => conversion.odometry(odometry)?,
            _ => None,
        };
        if let Some(broken) = broken {
            conversion.report.broken(*number, &broken);
        }
    }
    conversion.report.remarks = conversion.sources.iter().map(Source::text).collect();
    Ok(conversion.report)
}

struct Conversion<'a, W: Write + Seek> {
    rules: &'a Rules,
    writer: &'a mut RecordingWriter<W>,
    survey: &'a Survey,
    sources: Vec<Source>,
    mounts: Vec<(String, geometry::Pose)>,
    odometry_ns: BTreeSet<i64>,
    report: Report,
}

impl<W: Write + Seek> Conversion<'_, W> {
    /// Writes a scan, or returns what is wrong with its line.
    fn laser(&mut self, laser: &Laser) -> anyhow::Result<Option<Broken>> {
        let is_source = |source: &&mut Source| source.is_of(laser);
        let Some(source) = self.sources.iter_mut().find(is_source) else {
            let kind = format!("{} with scans of other lines", laser.name());
            self.report.leave_out(&kind);
            return Ok(None);
        };
        let Some(stamp) = Time::from_ns(laser.time_ns) else {
            return Ok(Some(late(laser.name(), laser.time_ns)));
        };
        let mounting = self.survey.parameters.of(laser.number);
        let angles = match angles::of(laser, mounting) {
            Ok(angles) => angles,
            Err(reason) => {
                return Ok(Some(Broken {
                    name: laser.name(),
                    fault: "with wrong angles",
                    reason,
                }));
            }
        };
        let message = source.scan(laser, angles, stamp, self.rules.range_max_m);
        let (topic, frame) = (source.topic.clone(), source.frame.clone());
        let missing = laser.ranges.iter().filter(|range| range.is_nan()).count();
        self.report.missing_readings += missing as u64;
        self.place(laser, stamp, &topic, &frame)?;
        if let Some(poses) = laser.poses {
            self.odometry_at(stamp, poses.robot, (0.0, 0.0))?;
        }
        self.report.scans += 1;
        self.write(&topic, stamp, &Message::Scan(message))?;
        Ok(None)
    }

    /// Writes the true pose of the laser, or its mount.
    fn place(
        &mut self,
        laser: &Laser,
        stamp: Time,
        topic: &str,
        frame: &str,
    ) -> anyhow::Result<()> {
        let mount = match laser.poses {
            Some(poses) if self.rules.truth && topic == SCAN => {
                return self.write(GROUND_TRUTH, stamp, &messages::truth(stamp, poses.laser));
            }
            Some(_) if self.rules.truth => None,
            Some(poses) => Some(poses.robot.inverse().then(poses.laser)),
            None => {
                let mounting = self.survey.parameters.of(laser.number);
                mounting.base_from_laser(laser.number)
            }
        };
        mount.map_or(Ok(()), |mount| self.mount(frame, mount, stamp))
    }

    /// Writes odometry, or returns what is wrong with its line.
    fn odometry(&mut self, odometry: &Odometry) -> anyhow::Result<Option<Broken>> {
        let Some(stamp) = Time::from_ns(odometry.time_ns) else {
            return Ok(Some(late("ODOM".to_owned(), odometry.time_ns)));
        };
        self.odometry_at(stamp, odometry.robot, odometry.velocities)?;
        Ok(None)
    }

    fn odometry_at(
        &mut self,
        stamp: Time,
        robot: geometry::Pose,
        (forward, turn): (f64, f64),
    ) -> anyhow::Result<()> {
        if !self.odometry_ns.insert(stamp.as_ns()) {
            return Ok(());
        }
        let motion = geometry::Pose::new(forward, 0.0, turn);
        self.report.odometry += 1;
        self.write(ODOM, stamp, &messages::odometry(stamp, robot, motion))
    }

    /// Writes the mount of a laser from the first line that has it.
    fn mount(
        &mut self,
        frame: &str,
        base_from_laser: geometry::Pose,
        stamp: Time,
    ) -> anyhow::Result<()> {
        let known = self.mounts.iter().find(|(other, _)| other == frame);
        if let Some((_, known)) = known {
            if !known.is_within(base_from_laser, SAME_MOUNT, SAME_MOUNT) {
                self.report.moved_mounts += 1;
            }
            return Ok(());
        }
        self.mounts.push((frame.to_owned(), base_from_laser));
        let mounts = self.mounts.iter();
        let mounts = mounts.map(|(frame, pose)| (frame.clone(), Transform::from_planar(*pose)));
        let message = messages::mounts(stamp, mounts);
        self.write(TF_STATIC, stamp, &message)
    }

    fn write(&mut self, topic: &str, stamp: Time, message: &Message) -> anyhow::Result<()> {
        Ok(self.writer.write(topic, stamp.as_ns(), message)?)
    }
}

fn late(name: String, time_ns: i64) -> Broken {
    Broken {
        name,
        fault: "with a wrong time",
        reason: format!("a recording cannot say a time of {time_ns} ns"),
    }
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

    fn converted(truth: bool) -> (Recording, Report) {
        let rules = Rules {
            truth,
            range_max_m: 80.0,
        };
        let mut writer = RecordingWriter::in_memory(Packing::Zstd).unwrap();
        let report = convert(LOG.as_bytes(), &rules, &mut writer).unwrap();
        let bytes = writer.finish().unwrap().into_inner();
        (Recording::from_bytes("r.mcap", bytes).unwrap(), report)
    }

    #[test]
    fn scans_odometry_and_the_mount_are_found() {
        let (recording, report) = converted(false);
        assert_eq!((report.scans, report.odometry), (2, 3));
        assert_eq!(report.moved_mounts, 0);
        let losses = report.losses();
        let broken = "1; the first, line 5, FLASER: of 3 readings 2 are there";
        assert!(
            losses.len() == 1 && losses[0].ends_with(broken),
            "{losses:?}"
        );
        assert_eq!(
            report.remarks,
            ["/scan holds FLASER: 2 scans, at first of 3 beams from -90.0 to 90.0°"]
        );
        let mount = recording.base_from_laser("laser").unwrap().unwrap();
        assert_eq!(mount.base_from_laser, geometry::Pose::new(0.5, 0.0, 0.0));
        let first = recording.records_of(&[Kind::Scan]).next().unwrap();
        let Message::Scan(scan) = first.unwrap().message else {
            panic!("asked for scans");
        };
        assert_eq!(
            (scan.ranges[1], scan.range_max, scan.header.stamp.sec),
            (81.83, 80.0, 1)
        );
    }

    #[test]
    fn corrected_poses_become_the_truth() {
        let (recording, _) = converted(true);
        let truths = recording.ground_truths().unwrap();
        assert_eq!(truths.len(), 2);
        assert_eq!(truths[&2_000_000_000].pose.x, 1.5);
        assert_eq!(recording.base_from_laser("laser").unwrap(), None);
    }
}
