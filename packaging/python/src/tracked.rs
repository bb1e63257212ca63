//! Pose of the robot for Python.

use engine::{Covariance, Pose};
use numpy::PyArray2;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::kept::{self, by_fields};
use crate::numbers::{self, PoseTuple, matrix};

by_fields! {
    /// Pose of the robot, its certainty, and the reason.
    #[pyclass(frozen, get_all, module = "backcast")]
    struct TrackedPose {
        /// Time of the scan, nanoseconds.
        stamp_ns: i64,
        /// State of the tracker: "Searching", the robot has not been found yet; "Unique", one
        /// place is left, and the scans fit there; "Doubtful", the pose is kept, but there is
        /// evidence against it; "Lost", the robot is not there any more.
        state: String,
        /// Reason for the state: "NoScan", "OnePlace", "SeveralPlaces", "TooEarly", "PoorFit",
        /// "OdometryJump", "AnotherPlace", "NoPlace" or "NoSearch".
        reason: String,
        /// Explanation of the reason, with what to do.
        why: String,
        /// Frame of the pose: "base" if a mount was given, otherwise "laser".
        frame: String,
        /// Pose in the map, (x, y, yaw) in metres and radians: the believed place, otherwise
        /// the leading one; None if there is no place.
        pose: Option<PoseTuple>,
        /// Covariance of pose, 3 × 3 over x, y and yaw in m², m·rad and rad²; if no place is
        /// believed, it spans all that are kept. None if there is no pose.
        covariance: Option<Py<PyArray2<f64>>>,
        /// Pose of the laser in any case, like pose.
        laser_pose: Option<PoseTuple>,
        /// Covariance of the laser in any case, like covariance.
        laser_covariance: Option<Py<PyArray2<f64>>>,
        /// Pose of the odometry's origin in the map, (x, y, yaw) in metres and radians; None
        /// without a pose or without odometry.
        map_from_odom: Option<PoseTuple>,
        /// Probability that the robot is there, 0 to 1.
        probability: f64,
        /// Score of the scan there, at most 1: how well it fits the map.
        score: f64,
        /// Natural logarithm of the odds of that probability.
        lead: f64,
        /// Number of places close to the best in weight, including it.
        places: u32,
        /// Time at which the state began, nanoseconds.
        since_ns: i64,
        /// Distance driven since then, metres.
        since_m: f64,
        /// True if the whole map was searched for this scan, which takes longer.
        searched: bool,
        /// Lasers whose scans were left out, with the reasons; empty if there are none.
        left_out: Vec<String>,
    }
}

impl TrackedPose {
    /// Makes the pose for Python.
    pub(crate) fn of(py: Python<'_>, tracked: &engine::TrackedPose) -> PyResult<Self> {
        let (report, laser) = (&tracked.report, tracked.laser());
        let (frame, best) = match tracked.is_mount_known {
            true => ("base", tracked.base()),
            false => ("laser", laser),
        };
        let pose = |of: Option<(Pose, Covariance)>| of.map(|(pose, _)| numbers::tuple(pose));
        let covariance = |of: Option<(Pose, Covariance)>| {
            let covariance = of.map(|(_, covariance)| matrix(py, covariance));
            covariance.transpose()
        };
        let left_out = tracked.left_out.iter();
        Ok(TrackedPose {
            stamp_ns: tracked.stamp_ns,
            state: report.state.as_str().to_owned(),
            reason: format!("{:?}", report.reason),
            why: report.words(),
            frame: frame.to_owned(),
            pose: pose(best),
            covariance: covariance(best)?,
            laser_pose: pose(laser),
            laser_covariance: covariance(laser)?,
            map_from_odom: tracked.map_from_odom().map(numbers::tuple),
            probability: report.probability,
            score: report.score,
            lead: report.lead,
            places: report.rivals,
            since_ns: report.since_ns,
            since_m: report.since_m,
            searched: tracked.is_searched,
            left_out: left_out
                .map(|(laser, why)| format!("laser {laser}: {why}"))
                .collect(),
        })
    }

    fn shown(&self) -> String {
        let what = format!("TrackedPose {}", self.state);
        kept::shown(&what, &self.frame, self.pose, &self.why)
    }
}
