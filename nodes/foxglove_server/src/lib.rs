//! Node `foxglove_server`: shows a graph live to whoever speaks Foxglove's WebSocket
//! protocol, as messages of ROS 2.
//!
//! What is shown is made by `ros_export`, as in recordings; the protocol is the `foxglove`
//! crate's. The graph never waits for viewers: who is too slow loses messages.

mod channels;
mod config;
mod error;
mod run;
mod serving;

pub use config::Config;
pub use error::ServerError;
pub use run::run;
