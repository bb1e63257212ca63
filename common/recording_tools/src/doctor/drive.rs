//! The scans of a laser and the odometry, as they are compared with each other.

use std::collections::BTreeMap;

use engine::motion::Motion;
use engine::scan::Scan;
use geometry::Pose;
use offline::each_odometry;
use recording::{Kind, Message, Recording};

/// A scan: NaN where nothing was read.
#[derive(Debug, Clone)]
pub(super) struct Look {
    pub(super) stamp_ns: i64,
    pub(super) ranges: Vec<f32>,
    /// From one beam to the next seen from above, radians: below zero for clockwise.
    pub(super) increment: f64,
}

/// A laser's scans, and how the robot moved by the odometry.
#[derive(Debug)]
pub(super) struct Drive {
    pub(super) looks: Vec<Look>,
    pub(super) odometry: Vec<i64>,
    pub(super) motion: Motion,
}

impl Drive {
    /// Reads the first laser's scans and the odometry; `None` where one is missing or
    /// cannot be read, which other checks say.
    pub(super) fn of(recording: &Recording) -> Option<Drive> {
        let scans = recording.topic(Kind::Scan).ok()??;
        let topic = recording.topic(Kind::Odometry).ok()??;
        let mut drive = Drive {
            looks: Vec::new(),
            odometry: Vec::new(),
            motion: Motion::keeping(usize::MAX),
        };
        each_odometry(recording, &topic, |odometry| {
            drive.add(odometry.stamp.measured_ns, odometry.odom_from_child.into());
        })
        .ok()?;
        let mut upside_down: BTreeMap<String, bool> = BTreeMap::new();
        for record in recording.records_of(&[Kind::Scan]).flatten() {
            let Message::Scan(scan) = &record.message else {
                continue;
            };
            if record.topic != scans {
                continue;
            }
            let frame = &scan.header.frame_id;
            let is_over = *upside_down.entry(frame.clone()).or_insert_with(|| {
                let mount = recording.base_from_laser(frame).ok().flatten();
                mount.is_some_and(|mount| mount.upside_down)
            });
            let taken = Scan {
                angle_min: scan.angle_min.into(),
                angle_increment: scan.angle_increment.into(),
                range_min_m: scan.range_min,
                range_max_m: scan.range_max,
                ranges: &scan.ranges,
            };
            let reading = |beam: usize| match taken.reading(beam) {
                Some(_) => scan.ranges.get(beam).copied().unwrap_or(f32::NAN),
                None => f32::NAN,
            };
            drive.looks.push(Look {
                stamp_ns: scan.header.stamp.as_ns(),
                ranges: (0..scan.ranges.len()).map(reading).collect(),
                increment: taken.angle_increment * if is_over { -1.0 } else { 1.0 },
            });
        }
        Some(drive)
    }

    /// Takes odometry.
    pub(super) fn add(&mut self, stamp_ns: i64, odom_from_child: Pose) {
        self.odometry.push(stamp_ns);
        self.motion.add(stamp_ns, odom_from_child);
    }

    /// How the robot moved between two scans by the odometry, if it says so.
    pub(super) fn moved(&self, before: &Look, now: &Look) -> Option<Pose> {
        let at = |look: &Look| self.motion.until(look.stamp_ns);
        Some(at(before)?.inverse().then(at(now)?))
    }
}
