//! Node `monitor`: a web page to watch a graph, and the API behind it.
//!
//! The page and the API are `dashboard`'s; here the messages of a graph are passed to
//! it, and what those with the token want to the graph. The graph never waits for
//! that: a sample is taken, and who is too slow loses messages.

mod config;
mod error;
mod run;

pub use config::Config;
pub use error::MonitorError;
pub use run::run;
