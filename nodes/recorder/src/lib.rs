//! Node `recorder`: writes the messages of the graph to an MCAP recording that the tools of ROS 2
//! can open.
//!
//! `ros_graph::export` converts the messages.
//!
//! | file | content |
//! |---|---|
//! | `events` | events on which a black box is saved; pure |
//! | `writing` | files: flushed, split, resumed after the disk was full; the black box |
//! | `run` | the graph, the signals, the writer thread |
//!
//! No node waits for the recorder: messages that arrive faster than they can be written are dropped
//! and counted.

mod config;
mod duration;
mod error;
mod events;
mod run;
mod writing;

pub use config::{Config, SyncPeriod};
pub use error::RecorderError;
pub use events::Event;
pub use run::run;
