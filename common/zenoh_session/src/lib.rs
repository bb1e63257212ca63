//! The Zenoh session of a node, as a user sets it: a file in Zenoh's own words,
//! options on top, and below both what keeps a machine to itself. What comes from
//! unknown senders is taken, counted and refused in the same way everywhere.
//!
//! For the nodes that join machines; nothing else links Zenoh.

mod error;
mod options;
mod queue;
mod report;
mod routers;
mod session;

pub use error::{Cause, KeyError, NetworkError};
pub use options::Options;
pub use queue::{Past, Queue, QueueLimits};
pub use report::Report;
pub use routers::Routers;
pub use session::{LOG, open, settings};
