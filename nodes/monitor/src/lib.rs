//! Node `monitor`: a web page to watch a graph, and its API.
//!
//! Crate `dashboard` implements the page and the API; this crate passes the messages of a graph to
//! it, and the requests of users with the token to the graph. The graph never waits for the
//! monitor: it takes samples, and a slow viewer loses messages.

mod config;
mod error;
mod run;

pub use config::Config;
pub use error::MonitorError;
pub use run::run;
