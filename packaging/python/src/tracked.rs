//! Where the robot is, as Python reads it.

use engine::peaks::Target;
use engine::tracking::Report;
use geometry::{Covariance, Pose};
use numpy::PyArray2;
use pyo3::prelude::*;

use crate::numbers::{self, PoseTuple, matrix};

/// Where the robot is, how sure that is, and why.
#[pyclass(frozen, get_all, module = "backcast")]
pub(crate) struct TrackedPose {
    /// Of the scan, nanoseconds.
    stamp_ns: i64,
    /// What is known: "Searching", the robot has not been found yet; "Unique", one place is
    /// left, and the scans fit there; "Doubtful", the pose is kept, but something speaks
    /// against it; "Lost", the robot is not there any more.
    state: &'static str,
    /// Why, in a word: "NoScan", "OnePlace", "SeveralPlaces", "TooEarly", "PoorFit",
    /// "OdometryJump", "AnotherPlace" or "NoPlace".
    reason: String,
    /// Why, in words, and what to do.
    why: String,
    /// Whose pose it is: "base" where a mount was given, else "laser".
    frame: &'static str,
    /// (x, y, yaw) in the map, metres and radians: the place that is believed, else the one
    /// that leads; None if there is none.
    pose: Option<PoseTuple>,
    /// The covariance of pose, 3 × 3 over x, y and yaw in m², m·rad and rad²; where no place
    /// is believed, it spans all that are kept. None if there is no pose.
    covariance: Option<Py<PyArray2<f64>>>,
    /// As pose, of the laser in any case.
    laser_pose: Option<PoseTuple>,
    /// As covariance, of the laser in any case.
    laser_covariance: Option<Py<PyArray2<f64>>>,
    /// Where the odometry's origin lies in the map, (x, y, yaw) in metres and radians; None
    /// without a pose or without odometry.
    map_from_odom: Option<PoseTuple>,
    /// How likely the robot is there, 0 to 1.
    probability: f64,
    /// How well the scan fits there, at most 1.
    score: f64,
    /// Natural logarithm of the odds of that probability.
    lead: f64,
    /// Places that come near the best, itself included.
    places: u32,
    /// When the state began, nanoseconds.
    since_ns: i64,
    /// Metres gone since.
    since_m: f64,
    /// Whether the whole map was searched for this scan, which takes longer.
    searched: bool,
}

/// The same before Python's lock is taken.
#[derive(Debug)]
pub(crate) struct Followed {
    pub(crate) stamp_ns: i64,
    pub(crate) report: Report,
    pub(crate) base_from_laser: Option<Pose>,
    /// Where the laser was by the odometry.
    pub(crate) odom_from_laser: Option<Pose>,
    pub(crate) searched: bool,
}

impl Followed {
    /// As Python reads it.
    pub(crate) fn read(self, py: Python<'_>) -> PyResult<TrackedPose> {
        let report = self.report;
        let target = Target::of(self.base_from_laser, false);
        let laser = report.pose;
        let pose = laser.map(|laser| match self.base_from_laser {
            Some(_) => target.base(laser),
            None => laser,
        });
        let of_laser = Covariance(report.covariance);
        let covariance = laser
            .zip(pose)
            .map(|(laser, pose)| of_laser.carried(laser, pose));
        let map_from_odom = laser
            .zip(self.odom_from_laser)
            .map(|(laser, odom)| laser.then(odom.inverse()));
        Ok(TrackedPose {
            stamp_ns: self.stamp_ns,
            state: report.state.as_str(),
            reason: format!("{:?}", report.reason),
            why: report.words(),
            frame: match self.base_from_laser {
                Some(_) => "base",
                None => "laser",
            },
            pose: pose.map(numbers::tuple),
            covariance: covariance.map(|of| matrix(py, of)).transpose()?,
            laser_pose: laser.map(numbers::tuple),
            laser_covariance: laser.map(|_| matrix(py, of_laser)).transpose()?,
            map_from_odom: map_from_odom.map(numbers::tuple),
            probability: report.probability,
            score: report.score,
            lead: report.lead,
            places: report.rivals,
            since_ns: report.since_ns,
            since_m: report.since_m,
            searched: self.searched,
        })
    }
}

#[pymethods]
impl TrackedPose {
    fn __repr__(&self) -> String {
        match self.pose {
            Some((x, y, yaw)) => format!(
                "<backcast.TrackedPose {}: {} at x {x:.3} m, y {y:.3} m, yaw {yaw:.4} rad; {}>",
                self.state, self.frame, self.why
            ),
            None => format!("<backcast.TrackedPose {}: {}>", self.state, self.why),
        }
    }
}
