//! Node `peak_extractor`: from the votes of a scan to the places where the
//! robot may be, from `votes`, `scan` and `map` to
//! `hypotheses` and, where asked for, `particles`.
//!
//! Each message of `votes` is answered by exactly one of `hypotheses`, also
//! where it holds nothing or is refused. How votes become places is the
//! engine's; `maps` and `scans` keep what votes refer to, `check` knows what
//! they have to be, `answer` what a message says. Only `run` touches the graph and
//! the clock.

pub mod answer;
pub mod check;
mod config;
mod error;
pub mod maps;
pub mod particles;
mod run;
pub mod scans;

pub use config::Config;
pub use error::PeakError;
pub use particles::ParticlesConfig;
pub use run::run;
