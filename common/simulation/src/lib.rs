//! Simulates drives through a map with lasers or a ring of sonars.
//!
//! [`Drive`] takes a map, a [`Path`] and a [`DriveConfig`] and returns a [`Snapshot`] for each
//! scan: the true pose, the odometry and the readings. Rays are cast continuously through the
//! occupied cells as squares, not along the engine's lines of cells, so that tests of the engine
//! are independent of it. Everything is seeded: the same numbers give the same drive. The crate
//! uses no files, no clock and no engine, and rejects a path through an obstacle.

mod angles;
mod config;
mod drive;
mod laser;
mod noise;
mod numbers;
mod obstacles;
mod odometry;
mod path;
mod people;
mod scene;
mod sonar;
#[cfg(test)]
mod testing;

pub use angles::Bearings;
pub use config::{DriveConfig, NamedMount};
pub use drive::{Drive, Snapshot, Wheels};
pub use laser::LaserConfig;
pub use noise::Noise;
pub use obstacles::Obstacles;
pub use odometry::OdometryConfig;
pub use path::Path;
pub use sonar::{SonarConfig, TRANSDUCERS_DEG};
