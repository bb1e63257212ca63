//! Node `boundary_extractor`: the obstacle cells that a laser can hit, from
//! `map` to `boundary`.
//!
//! `extraction` is the node without a graph; `run` receives and sends. A map that
//! cannot be used is refused, and the boundary of the one before stays in service.

mod config;
mod error;
pub mod extraction;
mod run;

pub use config::Config;
pub use error::BoundaryError;
pub use run::run;
