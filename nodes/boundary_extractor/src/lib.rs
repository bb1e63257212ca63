//! Node `boundary_extractor`: finds the obstacle cells that a laser can hit, from `map` to
//! `boundary`.
//!
//! `extraction` is the node without a graph; `run` receives and publishes. An unusable map is
//! refused, and the previous boundary stays published.

mod config;
mod error;
pub mod extraction;
mod run;

pub use config::Config;
pub use error::BoundaryError;
pub use run::run;
