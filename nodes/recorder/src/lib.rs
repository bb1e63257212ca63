//! Node `recorder`: writes what flows in the graph to an MCAP recording that the
//! tools of ROS 2 open.
//!
//! What it writes is made by `ros_export`.
//!
//! | file | what it is about |
//! |---|---|
//! | `events` | when a black box is to be saved; pure |
//! | `writing` | files: flushed, split, resumed when the disk was full; the black box |
//! | `run` | the graph, the signals, the thread that writes |
//!
//! Nothing waits for the recorder: what comes faster than it can be written is
//! dropped and counted.

mod config;
mod duration;
mod error;
mod events;
mod run;
mod writing;

pub use config::{Config, SyncPeriod};
pub use error::RecorderError;
pub use events::Event;
pub use run::{Summary, run};
