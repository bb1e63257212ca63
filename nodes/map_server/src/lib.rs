//! Node `map_server`: serves a map file as the latched topic `map`, and the new
//! map whenever the file or its image changes; or the maps of a set as `maps`, and of them
//! the one on which the robot is as `map`.
//!
//! `watch` decides when a change has come to rest, and `shown` which map of a set is shown,
//! both pure; `run` looks at the files, loads and sends. What a map file may hold is the
//! business of crate `map`. A map that turns out broken is refused and the old one stays.

mod config;
mod error;
mod files;
mod run;
mod set_files;
mod shown;
mod watch;

pub use config::Config;
pub use error::MapServerError;
pub use run::run;
