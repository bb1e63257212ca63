//! Node `tracker`: tracks the robot's pose over time and requests searches on `attention`. Each
//! scan is answered by exactly one pose, in the order of the scans; later scans wait behind a
//! search, so that the poses do not depend on timing. `world` holds the maps, `queue` the waiting
//! scans and answers. Only `run` uses the graph and the clock.

mod config;
mod error;
mod memory;
mod message;
mod queue;
mod run;
mod world;

pub use config::Config;
pub use error::TrackerError;
pub use run::run;
