//! Node `accumulator`: where on the map could each scan have been taken? From
//! `scan`, `map` and `boundary` to `votes`, and to `field` while somebody looks.
//!
//! Each scan is answered by exactly one message of `votes`, also where it is
//! refused or explains nothing. A new map is prepared in the background while
//! scans are answered with the one before. The search itself is the engine's;
//! `preparation` knows what a map has to be, `answer` what a message says, `sonar` what
//! wide beams are read as. Only `run` touches the graph and the clock.

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
