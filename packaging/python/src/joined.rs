//! Scans of several lasers, joined at one time, and the motion within a scan taken out: by the
//! engine's code, as in the graph.

use engine::joined::{JoinConfig, Joiner, MotionConfig, TimedScan};
use geometry::Pose;
use numpy::{PyReadonlyArray1, PyReadonlyArray2, get_array_module};
use pyo3::prelude::*;

use crate::error::{of_engine, value};

/// Odometry: stamps in nanoseconds, and poses of the base.
pub(crate) type Poses = Vec<(i64, Pose)>;

/// Joins scans at the time of the first. Of several lasers the pose of the base is searched, of one
/// that of the laser.
pub(crate) fn join(scans: &[TimedScan<'_>], odometry: &Poses) -> PyResult<Joiner> {
    TimedScan::check_all(scans).map_err(of_engine)?;
    let config = JoinConfig::of_lasers(scans.len(), MotionConfig::default());
    let mut joiner = Joiner::keeping_all(config);
    for &(stamp_ns, odom_from_base) in odometry {
        joiner.add_odometry(stamp_ns, odom_from_base);
    }
    for (laser, scan) in scans.iter().enumerate() {
        joiner.add_scan(laser, scan);
    }
    let brought = joiner.bring().map_err(of_engine)?;
    match brought.left_out.first() {
        Some((laser, reason)) => Err(value(format!("laser {laser}: {reason}"))),
        None => Ok(joiner),
    }
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
