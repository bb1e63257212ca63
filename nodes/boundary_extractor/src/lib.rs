//! Node `boundary_extractor`: finds the obstacle cells that a laser can hit. An unusable map is
//! refused, and the previous boundary stays published.

mod config;
mod error;
pub mod extraction;
mod run;

pub use config::Config;
pub use error::BoundaryError;
pub use run::run;
