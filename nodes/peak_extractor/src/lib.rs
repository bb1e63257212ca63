//! Node `peak_extractor`: from the votes of a scan to the places where the
//! robot may be, from `votes` and `map` to `hypotheses`.
//!
//! Each message of `votes` is answered by exactly one of `hypotheses`, also
//! where it holds nothing or is refused. How votes become places is the
//! engine's; `geometries` knows where the grids of maps lie, `check` what votes
//! have to be, `answer` what a message says. Only `run` touches the graph and
//! the clock.

pub mod answer;
pub mod check;
mod config;
mod error;
pub mod geometries;
mod run;

pub use config::Config;
pub use error::PeakError;
pub use run::run;
