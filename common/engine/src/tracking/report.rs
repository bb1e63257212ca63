//! What the tracker says.

use geometry::Pose;
use nalgebra::Matrix3;

/// What the tracker knows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum State {
    /// It has not found the robot yet.
    Searching,
    /// One place is left, and the scans fit there.
    Unique,
    /// The pose is kept, but something speaks against it.
    Doubtful,
    /// It had the robot, and the scans say that it is not there any more.
    Lost,
}

/// Where the robot is, and how sure that is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Report {
    /// What is known.
    pub state: State,
    /// Of the frame that is sought, in the map.
    pub pose: Option<Pose>,
    /// Of that pose.
    pub covariance: Matrix3<f64>,
    /// How well the last scan fits there, at most 1.
    pub score: f64,
    /// By how much the place leads, natural logarithm of odds.
    pub lead: f64,
    /// Places that are kept.
    pub places: usize,
    /// When the state began, nanoseconds.
    pub since_ns: i64,
    /// Metres gone since.
    pub since_m: f64,
}
