//! Node `map_server`: serves a map file as the latched topic `map`, and again whenever the file or
//! its image changes; or the maps of a set as `maps`, and the one on which the robot is as `map`.
//!
//! `watch` decides when a change is complete, and `shown` which map of a set is displayed, both
//! pure; `run` checks the files, loads and publishes. Crate `map` defines the format of map files.
//! A map that turns out broken is rejected, and the previous one stays.

mod config;
mod error;
mod files;
mod run;
mod shown;
mod watch;

pub use config::Config;
pub use error::MapServerError;
pub use run::{check, run};
