//! Node `monitor`: a web page to watch a graph, and the API behind it.
//!
//! | file | what it is about |
//! |---|---|
//! | `told` | what the page is told, from the messages of the graph; pure |
//! | `robot` | what is known of one robot, and whoever watches it |
//! | `server` | HTTP and WebSocket: the gate, the API, the page |
//! | `run` | the graph, and the thread of the server |
//!
//! The graph never waits for it: a sample is taken, put into words once and
//! handed to everybody who watches, and who is too slow loses messages and is
//! told how many. It localizes nothing, and shows nothing that no node said.

mod config;
mod error;
mod robot;
mod run;
mod server;
mod token;
mod told;

pub use config::Config;
pub use error::MonitorError;
pub use run::run;
