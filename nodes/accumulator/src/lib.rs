//! Node `accumulator`: finds the poses on the map at which each scan may have been taken. Each scan
//! is answered by exactly one message of `votes`. A new map is prepared in the background.
//! `preparation` checks and prepares maps, `answer` builds the messages, `sonar` interprets wide
//! beams. Only `run` uses the graph and the clock.

pub mod answer;
mod config;
mod error;
mod kept;
pub mod preparation;
mod run;
pub mod sonar;
mod subject;

pub use config::Config;
pub use error::AccumulatorError;
pub use run::run;
pub use subject::Subject;
