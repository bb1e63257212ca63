//! Planar geometry: poses in SE(2), angles and covariances, on nalgebra.
//!
//! Lengths are in metres and angles in radians, counter-clockwise. A transform names both frames,
//! target first: `map_from_laser` transforms laser coordinates to the map. The crate knows neither
//! grids nor sensors.

#![warn(missing_docs)]

mod angle;
mod covariance;
mod mount;
mod pose;

pub use angle::{angle_between, wrap_angle};
pub use covariance::{ANGLE_95, Covariance, ELLIPSE_95, Ellipse};
pub use mount::{Mount, MountError};
pub use pose::Pose;
