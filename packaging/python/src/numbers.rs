//! Conversion of poses and covariances: from any sequence of numbers in Python, and to tuples and
//! arrays.

use geometry::{Covariance, Pose};
use numpy::{PyArray1, PyArray2, PyArray3, PyArrayMethods};
use pyo3::prelude::*;

use crate::error::value;

/// Pose in Python: x and y in metres, and yaw in radians.
pub(crate) type PoseTuple = (f64, f64, f64);

/// Reads a pose of three numbers.
pub(crate) fn pose(name: &str, given: &Bound<'_, PyAny>) -> PyResult<Pose> {
    let numbers = row(name, given, "(x, y, yaw) in metres and radians")?;
    match numbers[..] {
        [x, y, yaw] if numbers.iter().all(|n| n.is_finite()) => Ok(Pose::new(x, y, yaw)),
        [_, _, _] => Err(value(format!(
            "{name} is {numbers:?}; allowed: three finite numbers, (x, y, yaw) in metres and \
             radians"
        ))),
        _ => Err(value(format!(
            "{name} has {} numbers; allowed: three, (x, y, yaw) in metres and radians",
            numbers.len()
        ))),
    }
}

/// Reads where a laser is mounted on the robot.
pub(crate) fn mount(given: &Bound<'_, PyAny>) -> PyResult<Pose> {
    /// Farthest that a laser is from the base, metres, as for the command.
    const FARTHEST_M: f64 = 10.0;
    let mount = pose("mount", given)?;
    let is_near = mount.x.hypot(mount.y) <= FARTHEST_M;
    match is_near && mount.yaw.abs() <= std::f64::consts::TAU {
        true => Ok(mount),
        false => Err(value(format!(
            "mount is {:?}; allowed: (x, y, yaw) within {FARTHEST_M} m and a turn, in metres and \
             radians",
            tuple(mount)
        ))),
    }
}

/// Reads the numbers of a tuple, a list or an array of one dimension.
pub(crate) fn row(name: &str, given: &Bound<'_, PyAny>, allowed: &str) -> PyResult<Vec<f64>> {
    let numbers = given.try_iter().and_then(|items| {
        let numbers = items.map(|item| item?.extract::<f64>());
        numbers.collect::<PyResult<Vec<f64>>>()
    });
    numbers.map_err(|_| value(format!("{name} is {given}; allowed: {allowed}")))
}

/// Reads rows of numbers, all of this length; `None` if it is something else.
pub(crate) fn rows<const N: usize>(given: &Bound<'_, PyAny>) -> Option<Vec<[f64; N]>> {
    let numbers = |given: PyResult<Bound<'_, PyAny>>| row("row", &given.ok()?, "numbers").ok();
    let rows = given.try_iter().ok()?;
    rows.map(|row| numbers(row)?.try_into().ok()).collect()
}

/// Reads the covariance of a pose, three rows of three numbers.
pub(crate) fn covariance(name: &str, given: &Bound<'_, PyAny>) -> PyResult<Covariance> {
    let wrong = || {
        value(format!(
            "{name} is {given}; allowed: 3 × 3 finite numbers over (x, y, yaw) in metres and \
             radians, symmetric and positive definite"
        ))
    };
    let numbers = rows::<3>(given).and_then(|rows| rows.concat().try_into().ok());
    let covariance = numbers.map(Covariance::from_rows);
    covariance
        .filter(|covariance| covariance.is_positive_definite())
        .ok_or_else(wrong)
}

pub(crate) fn tuple(pose: Pose) -> PoseTuple {
    (pose.x, pose.y, pose.yaw)
}

/// Makes the homogeneous matrix of a pose, 3 × 3.
pub(crate) fn homogeneous(py: Python<'_>, (x, y, yaw): PoseTuple) -> PyResult<Py<PyArray2<f64>>> {
    let (sin, cos) = yaw.sin_cos();
    let rows = vec![cos, -sin, x, sin, cos, y, 0.0, 0.0, 1.0];
    Ok(PyArray1::from_vec(py, rows).reshape([3, 3])?.unbind())
}

/// Makes an array of N × 3.
pub(crate) fn poses(py: Python<'_>, poses: &[Pose]) -> PyResult<Py<PyArray2<f64>>> {
    let numbers = poses.iter().flat_map(|pose| [pose.x, pose.y, pose.yaw]);
    let flat = PyArray1::from_vec(py, numbers.collect());
    Ok(flat.reshape([poses.len(), 3])?.unbind())
}

/// Makes an array of N × 3 × 3.
pub(crate) fn covariances(py: Python<'_>, all: &[Covariance]) -> PyResult<Py<PyArray3<f64>>> {
    let numbers = all.iter().flat_map(|covariance| covariance.to_rows());
    let flat = PyArray1::from_vec(py, numbers.collect());
    Ok(flat.reshape([all.len(), 3, 3])?.unbind())
}

/// Makes an array of 3 × 3.
pub(crate) fn matrix(py: Python<'_>, covariance: Covariance) -> PyResult<Py<PyArray2<f64>>> {
    let flat = PyArray1::from_vec(py, covariance.to_rows().to_vec());
    Ok(flat.reshape([3, 3])?.unbind())
}
