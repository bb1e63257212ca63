//! Node `accumulator`: finds the poses on the map at which each scan may have been taken. From
//! `scan`, `map` and `boundary` to `votes`, and to `field` while it has a subscriber.
//!
//! Each scan is answered by exactly one message of `votes`, even if it is refused or nothing
//! explains it. A new map is prepared in the background while scans are answered with the previous
//! one. The engine does the search; `preparation` checks and prepares maps, `answer` builds the
//! messages, `sonar` interprets wide beams. Only `run` uses the graph and the clock.

pub mod answer;
mod background;
mod config;
mod error;
mod kept;
mod pace;
pub mod preparation;
mod run;
pub mod sonar;
mod subject;

pub use config::Config;
pub use error::AccumulatorError;
pub use run::run;
pub use subject::Subject;
