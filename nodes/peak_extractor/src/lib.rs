//! Node `peak_extractor`: finds the places where the robot may be from the votes of a scan. Each
//! message of `votes` is answered by exactly one of `hypotheses`. `maps` and `scans` store the data
//! that votes refer to, `check` validates votes, `answer` builds the messages. Only `run` uses the
//! graph and the clock.

pub mod answer;
pub mod check;
mod config;
mod error;
pub mod maps;
pub mod particles;
mod run;
pub mod scans;
#[cfg(test)]
mod testing;

pub use config::Config;
pub use error::PeakError;
pub use particles::ParticlesConfig;
pub use run::run;
