//! Converts a log to a recording.

use std::collections::BTreeSet;
use std::io::{BufRead, Seek, Write};

use recording::write::RecordingWriter;
use recording::{GROUND_TRUTH, Message, ODOM, SCAN, TF_STATIC};
use ros::{Time, Transform};
use transport::with_causes;

use super::angles;
use super::carmen::{Broken, Fault, Laser, Line, Odometry};
use super::file::for_each_line;
use super::read;
use super::report::Report;
use super::source::Source;
use super::survey::Survey;
use crate::messages;

/// Largest difference of two equal mounts, in metres and radians: logs have six digits.
const SAME_MOUNT: f64 = 1e-3;

#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Rules {
    pub(super) truth: bool,
    pub(super) range_max_m: f32,
}

/// Converts a log, which `open` opens for each of two passes. Lines that cannot be read are
/// counted.
pub(super) fn convert<W: Write + Seek, L: BufRead>(
    open: impl Fn() -> anyhow::Result<L>,
    rules: &Rules,
    writer: &mut RecordingWriter<W>,
) -> anyhow::Result<Report> {
    let survey = Survey::of(open()?);
    let mut conversion = Conversion {
        rules,
        writer,
        sources: Source::all(&survey),
        survey: &survey,
        mounts: Vec::new(),
        odometry_ns: BTreeSet::new(),
        report: Report::default(),
    };
    let read = for_each_line(open()?, |number, line| conversion.line(number, line))?;
    conversion.report.damage = read.err().map(|error| with_causes(&error));
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
    fn line(&mut self, number: u64, line: &str) -> anyhow::Result<()> {
        match read::parse(line) {
            Ok(Line::Laser(laser)) => self.laser(&laser, number)?,
            Ok(Line::Odometry(odometry)) => self.odometry(&odometry, number)?,
            Ok(Line::Parameter(_) | Line::Nothing) => {}
            Ok(Line::Other(name)) => self.report.tally.other(&name),
            Err(broken) => self.report.tally.broken(number, &broken),
        }
        Ok(())
    }

    fn laser(&mut self, laser: &Laser, number: u64) -> anyhow::Result<()> {
        let is_source = |source: &&mut Source| source.is_of(laser);
        let Some(source) = self.sources.iter_mut().find(is_source) else {
            self.report.tally.repeated(laser.name());
            return Ok(());
        };
        let Some((ns, stamp)) = moment(laser.time_ns) else {
            let broken = late(laser.name(), laser.time_ns);
            self.report.tally.broken(number, &broken);
            return Ok(());
        };
        let mounting = self.survey.parameters.of(laser.number);
        let angles = match angles::of(laser, mounting) {
            Ok(angles) => angles,
            Err(reason) => {
                let broken = Broken {
                    name: laser.name(),
                    fault: Fault::Angles,
                    reason,
                };
                self.report.tally.broken(number, &broken);
                return Ok(());
            }
        };
        let message = source.scan(laser, angles, stamp, self.rules.range_max_m);
        let (topic, frame) = (source.topic.clone(), source.frame.clone());
        let missing = laser.ranges.iter().filter(|range| range.is_nan()).count();
        self.report.tally.missing_readings += missing as u64;
        self.place(laser, (ns, stamp), &topic, &frame)?;
        if let Some(poses) = laser.poses {
            self.odometry_at(ns, stamp, poses.robot, (0.0, 0.0))?;
        }
        self.report.scans += 1;
        Ok(self.writer.write(&topic, ns, &Message::Scan(message))?)
    }

    /// Writes the true pose of the laser, or its mount.
    fn place(
        &mut self,
        laser: &Laser,
        (ns, stamp): (i64, Time),
        topic: &str,
        frame: &str,
    ) -> anyhow::Result<()> {
        let mount = match laser.poses {
            Some(poses) if self.rules.truth && topic == SCAN => {
                let truth = messages::truth(stamp, poses.laser);
                return Ok(self.writer.write(GROUND_TRUTH, ns, &truth)?);
            }
            Some(_) if self.rules.truth => None,
            Some(poses) => Some(poses.robot.inverse().then(poses.laser)),
            None => {
                let mounting = self.survey.parameters.of(laser.number);
                mounting.base_from_laser(laser.number)
            }
        };
        match mount {
            Some(mount) => self.mount(ns, frame, mount, stamp),
            None => Ok(()),
        }
    }

    fn odometry(&mut self, odometry: &Odometry, number: u64) -> anyhow::Result<()> {
        match moment(odometry.time_ns) {
            Some((ns, stamp)) => self.odometry_at(ns, stamp, odometry.robot, odometry.velocities),
            None => {
                let broken = late("ODOM".to_owned(), odometry.time_ns);
                self.report.tally.broken(number, &broken);
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
    ) -> anyhow::Result<()> {
        if !self.odometry_ns.insert(ns) {
            return Ok(());
        }
        let motion = geometry::Pose::new(forward, 0.0, turn);
        self.report.odometry += 1;
        let message = messages::odometry(stamp, robot, motion);
        Ok(self.writer.write(ODOM, ns, &message)?)
    }

    /// Writes the mount of a laser from the first line that has it.
    fn mount(
        &mut self,
        ns: i64,
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
        Ok(self.writer.write(TF_STATIC, ns, &message)?)
    }
}

fn late(name: String, time_ns: i64) -> Broken {
    Broken {
        name,
        fault: Fault::Time,
        reason: format!("a recording cannot say a time of {time_ns} ns"),
    }
}

/// Converts a time, if a recording can represent it.
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

    fn converted(log: &str, rules: &Rules) -> (Recording, Report) {
        let mut writer = RecordingWriter::in_memory(Packing::Zstd).unwrap();
        let report = convert(|| Ok(log.as_bytes()), rules, &mut writer).unwrap();
        let bytes = writer.finish().unwrap().into_inner();
        (Recording::from_bytes("r.mcap", bytes).unwrap(), report)
    }

    #[test]
    fn scans_odometry_and_the_mount_are_found() {
        let rules = Rules {
            truth: false,
            range_max_m: 80.0,
        };
        let (recording, report) = converted(LOG, &rules);
        assert_eq!((report.scans, report.odometry), (2, 3));
        assert_eq!((report.tally.broken_lines(), report.moved_mounts), (1, 0));
        assert_eq!(
            report.tally.first_broken.as_deref(),
            Some("line 5, FLASER: of 3 readings 2 are there")
        );
        assert_eq!(
            report.tally.text().as_deref(),
            Some("1 FLASER line cut short")
        );
        assert_eq!(
            report.remarks,
            ["/scan holds FLASER: 2 scans, at first of 3 beams from -90.0 to 90.0°"]
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
        let (recording, _) = converted(LOG, &rules);
        let truths = recording.ground_truths().unwrap();
        assert_eq!(truths.len(), 2);
        assert_eq!(truths[&2_000_000_000].pose.x, 1.5);
        assert_eq!(recording.base_from_laser("laser").unwrap(), None);
    }
}
