//! Node `foxglove_server`: shows a graph live to any viewer with Foxglove's WebSocket protocol, as
//! messages of ROS 2.
//!
//! `ros_graph::export` converts the messages, as for recordings; the `foxglove` crate implements the
//! protocol. The graph never waits for viewers: a slow one loses messages.

mod channels;
mod config;
mod error;
mod listening;
mod run;
mod serving;

pub use config::Config;
pub use error::ServerError;
pub use run::run;
