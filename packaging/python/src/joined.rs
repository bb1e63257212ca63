//! Scans of several lasers, joined at one time, and the motion within a scan taken out: by the
//! engine's code, as in the graph.

use bytemuck::Zeroable;
use engine::joined::{JoinConfig, Joiner};
use geometry::Pose;
use messages::{FrameName, Name, Odometry, ScanHeader, Stamp};
use numpy::{PyReadonlyArray1, PyReadonlyArray2, get_array_module};
use pyo3::prelude::*;

use crate::error::{of_engine, value};
use crate::scan::GivenScan;

/// Largest time between the scans of two lasers, nanoseconds.
const MOST_APART_NS: i64 = 1_000_000_000;

/// Odometry: stamps in nanoseconds, and poses of the base.
pub(crate) type Poses = Vec<(i64, Pose)>;

/// Joins scans at the time of the first. Of several lasers the pose of the base is searched, of one
/// that of the laser.
pub(crate) fn join(scans: &[&GivenScan], odometry: &Poses) -> PyResult<Joiner> {
    if scans.len() > 1 {
        check(scans)?;
    }
    let names = (0..scans.len()).map(|index| index.to_string());
    let mut joiner = Joiner::keeping_all(JoinConfig {
        scans: names.filter(|_| scans.len() > 1).collect(),
        ..JoinConfig::default()
    });
    for &(stamp_ns, odom_from_base) in odometry {
        joiner.on_odometry(&message(stamp_ns, odom_from_base));
    }
    for (index, scan) in scans.iter().enumerate() {
        let laser = Name::new(&index.to_string());
        joiner.on_scan(
            &ScanHeader {
                laser,
                ..header(scan)
            },
            scan.ranges(),
        );
    }
    let brought = joiner.bring().map_err(|error| of_engine(&error))?;
    match brought.left_out.first() {
        Some((index, reason)) => Err(value(format!("scans[{index}]: {reason}"))),
        None => Ok(joiner),
    }
}

fn check(scans: &[&GivenScan]) -> PyResult<()> {
    for (index, scan) in scans.iter().enumerate() {
        if scan.base_from_laser.is_none() {
            return Err(value(format!(
                "scans[{index}].mount is None; allowed: (x, y, yaw) on the base, for each of \
                 several lasers"
            )));
        }
        let later_ns = scan.stamp_ns.saturating_sub(scans[0].stamp_ns);
        if later_ns.saturating_abs() > MOST_APART_NS {
            return Err(value(format!(
                "scans[{index}].stamp_ns is {}, {later_ns} after that of scans[0]; allowed: \
                 within {MOST_APART_NS} nanoseconds",
                scan.stamp_ns
            )));
        }
    }
    Ok(())
}

/// Reads odometry: stamps in nanoseconds, and as many poses.
pub(crate) fn odometry(given: &Bound<'_, PyAny>) -> PyResult<Poses> {
    let wrong = |found: String| {
        value(format!(
            "odometry {found}; allowed: (stamps_ns, poses), integers of shape (n,) in nanoseconds \
             and finite numbers of shape (n, 3), (x, y, yaw) in metres and radians"
        ))
    };
    let (stamps_ns, poses): (Bound<'_, PyAny>, Bound<'_, PyAny>) =
        given.extract().map_err(|_| wrong(format!("is {given}")))?;
    let numpy = get_array_module(given.py())?;
    let stamps_ns = numpy.call_method1("asarray", (stamps_ns,))?;
    let poses = numpy.call_method1("asarray", (poses, "float64"));
    let poses = poses.map_err(|error| wrong(format!("has poses that are no array ({error})")))?;
    let (Ok(stamps_ns), Ok(poses)) = (
        stamps_ns.extract::<PyReadonlyArray1<'_, i64>>(),
        poses.extract::<PyReadonlyArray2<'_, f64>>(),
    ) else {
        return Err(wrong(format!("has {stamps_ns:?} and {poses:?}")));
    };
    let (stamps_ns, poses) = (stamps_ns.as_array(), poses.as_array());
    if poses.dim() != (stamps_ns.len(), 3) || poses.iter().any(|n| !n.is_finite()) {
        let (stamps, shape) = (stamps_ns.len(), poses.dim());
        return Err(wrong(format!("has {stamps} stamps and poses of {shape:?}")));
    }
    let poses = poses
        .rows()
        .into_iter()
        .map(|row| Pose::new(row[0], row[1], row[2]));
    Ok(stamps_ns.iter().copied().zip(poses).collect())
}

/// Makes the graph's message of the base's pose by odometry.
pub(crate) fn message(stamp_ns: i64, odom_from_base: Pose) -> Odometry {
    Odometry {
        stamp: stamp(stamp_ns),
        odom_from_child: odom_from_base.into(),
        child_frame: FrameName::new("base"),
        ..Odometry::zeroed()
    }
}

/// Makes the header of the graph's message of a scan.
pub(crate) fn header(scan: &GivenScan) -> ScanHeader {
    ScanHeader {
        stamp: stamp(scan.stamp_ns),
        angle_min: scan.angle_min,
        angle_increment: scan.angle_increment,
        time_increment_s: scan.time_increment,
        range_min_m: scan.range_min_m,
        range_max_m: scan.range_max_m,
        base_from_laser: scan.base_from_laser.unwrap_or_default().into(),
        mount_known: scan.base_from_laser.is_some().into(),
        upside_down: scan.upside_down.into(),
        frame: FrameName::new("laser"),
        ..ScanHeader::zeroed()
    }
}

fn stamp(measured_ns: i64) -> Stamp {
    Stamp {
        measured_ns,
        ..Stamp::default()
    }
}
