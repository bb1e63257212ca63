//! A drive by its odometry and by its scans, each matched to the previous one without a map.

use engine::beams::BeamConfig;
use engine::fit::{Ends, FitConfig};
use engine::motion::Motion;
use engine::scan::Scan;
use engine::space::Space;
use engine::tracking::{ScanMatcher, TrackingConfig};
use geometry::Pose;
use offline::{as_measured, each_odometry};
use recording::{Kind, Message, Recording};

/// Largest number of scans that are matched: minutes of a laser of 10 Hz, seconds of computing.
const MAX_MATCHED: usize = 2000;

/// Side of a cell of a scan that others are matched to, in metres, and number of cells that a beam
/// may cross along each axis.
const CELL_M: f64 = 0.05;
const CELLS: usize = 400;

/// Bearings of beams are not rounded here, so any number works.
const HEADINGS: u32 = 360;

/// Fewest ranges of a scan that does not repeat by chance.
const MIN_READINGS: usize = 30;

/// A covered laser reads one range, within `COVER_M` metres, for this share of its beams. They must
/// span at least `COVER_FIELD` radians, because a narrow laser may see a flat wall.
const COVER_M: f32 = 0.03;
const COVER_SHARE: f64 = 0.95;
const COVER_FIELD: f64 = std::f64::consts::FRAC_PI_2;

/// Largest plausible distance of a laser from the base of its robot, in metres.
const FAR_MOUNT_M: f64 = 10.0;

pub(super) fn is_far(base_from_laser: Pose) -> bool {
    base_from_laser.distance_to(Pose::IDENTITY) > FAR_MOUNT_M
}

#[derive(Debug, Clone, Copy)]
pub(super) struct Look {
    pub(super) stamp_ns: i64,
    /// Motion of the laser since the previous scan, if the two match.
    pub(super) step: Option<Pose>,
    /// True if all ranges equal those of the previous scan, to the last bit.
    pub(super) is_repeated: bool,
    /// Range of nearly all beams in metres, if they agree.
    pub(super) only_range_m: Option<f32>,
}

/// The scans of a laser, and the motion of the robot by odometry.
#[derive(Debug)]
pub(super) struct Drive {
    pub(super) looks: Vec<Look>,
    /// Stamps of the odometry, in nanoseconds.
    pub(super) odometry_ns: Vec<i64>,
    pub(super) motion: Motion,
    /// Pose of the laser in the child frame of the odometry.
    child_from_laser: Pose,
    matcher: ScanMatcher,
    space: Space,
    readings: Vec<Option<u64>>,
}

/// A section of the drive for which both scans and odometry give the motion of the laser.
#[derive(Debug, Clone, Copy)]
pub(super) struct Stretch {
    pub(super) by_scans: Pose,
    pub(super) by_odometry: Pose,
}

impl Drive {
    pub(super) fn new(child_from_laser: Pose) -> Option<Self> {
        Some(Drive {
            looks: Vec::new(),
            odometry_ns: Vec::new(),
            motion: Motion::keeping(usize::MAX),
            child_from_laser,
            matcher: ScanMatcher::default(),
            space: Space::new(HEADINGS, CELL_M, CELLS, CELLS).ok()?,
            readings: Vec::new(),
        })
    }

    /// Reads the scans of the first laser and the odometry; `None` if one is missing or cannot be
    /// read, which other checks report.
    pub(super) fn of(recording: &Recording) -> Option<Self> {
        let scans = recording.topic(Kind::Scan).ok()??;
        let odometry = recording.topic(Kind::Odometry).ok()??;
        let mut drive = Drive::new(Pose::IDENTITY)?;
        let mut child = String::new();
        each_odometry(recording, &odometry, |odometry| {
            child = odometry.child_frame.as_str().to_owned();
            let pose = odometry.odom_from_child.into();
            drive.add_odometry(odometry.stamp.measured_ns, pose);
        })
        .ok()?;
        let mut mount = None;
        for record in recording.records_of(&[Kind::Scan]).flatten() {
            let Message::Scan(scan) = &record.message else {
                continue;
            };
            if record.topic != scans {
                continue;
            }
            let (child_from_laser, is_upside_down) = *mount.get_or_insert_with(|| {
                let frame = &scan.header.frame_id;
                let mounted = recording.mounted(frame).ok().and_then(|found| found.mount);
                mounted.map_or((Pose::IDENTITY, false), |mount| {
                    let child_from_laser = match *frame == child {
                        true => Pose::IDENTITY,
                        false => mount.base_from_laser,
                    };
                    (child_from_laser, mount.upside_down)
                })
            });
            drive.child_from_laser = child_from_laser;
            let seen = as_measured(scan).seen_from_above(is_upside_down);
            drive.add_scan(scan.header.stamp.as_ns(), seen);
        }
        Some(drive)
    }

    /// True if the laser is so far away that the smallest turn moves it sideways.
    pub(super) fn has_far_mount(&self) -> bool {
        is_far(self.child_from_laser)
    }

    pub(super) fn add_odometry(&mut self, stamp_ns: i64, odom_from_child: Pose) {
        self.odometry_ns.push(stamp_ns);
        self.motion.add(stamp_ns, odom_from_child);
    }

    pub(super) fn add_scan(&mut self, stamp_ns: i64, scan: Scan<'_>) {
        let readings = (0..scan.beams()).map(|beam| scan.reading(beam));
        let bits: Vec<Option<u64>> = readings.clone().map(|r| r.map(f64::to_bits)).collect();
        let mut read: Vec<f32> = readings.flatten().map(|range| range as f32).collect();
        let step = self.matched(scan);
        self.looks.push(Look {
            stamp_ns,
            step,
            is_repeated: read.len() >= MIN_READINGS && bits == self.readings,
            only_range_m: only_range(&mut read, scan.angle_increment.abs()),
        });
        self.readings = bits;
    }

    fn matched(&mut self, scan: Scan<'_>) -> Option<Pose> {
        if self.looks.len() >= MAX_MATCHED {
            return None;
        }
        let ends = Ends::new(&scan, &self.space, &BeamConfig::default()).ok()?;
        let how = (CELL_M, &FitConfig::default());
        self.matcher.step(&ends, how, &TrackingConfig::default())
    }

    pub(super) fn moved(&self, from: &Look, to: &Look) -> Option<Pose> {
        let at = |look: &Look| {
            let odom_from_child = self.motion.until(look.stamp_ns)?;
            Some(odom_from_child.then(self.child_from_laser))
        };
        Some(at(from)?.inverse().then(at(to)?))
    }

    /// Splits the drive into sections in which the laser moved by at least this distance in metres
    /// or this angle in radians, by odometry.
    pub(super) fn stretches(&self, (metres, radians): (f64, f64)) -> Vec<Stretch> {
        let mut found = Vec::new();
        let Some(mut start) = self.looks.first() else {
            return found;
        };
        let mut gone = Pose::IDENTITY;
        for look in &self.looks {
            if let (Some(step), Some(by_odometry)) = (look.step, self.moved(start, look)) {
                gone = gone.then(step);
                if by_odometry.is_within(Pose::IDENTITY, metres, radians) {
                    continue;
                }
                found.push(Stretch {
                    by_scans: gone,
                    by_odometry,
                });
            }
            (start, gone) = (look, Pose::IDENTITY);
        }
        found
    }
}

/// Range of nearly all beams, if they agree; `increment` is the angle between beams in radians.
fn only_range(read: &mut [f32], increment: f64) -> Option<f32> {
    read.sort_unstable_by(f32::total_cmp);
    let middle = *read.get(read.len() / 2)?;
    let is_near = |range: &&f32| (**range - middle).abs() <= COVER_M;
    let near = read.iter().filter(is_near).count() as f64;
    let is_wide = near * increment >= COVER_FIELD;
    (is_wide && near >= COVER_SHARE * read.len() as f64).then_some(middle)
}
