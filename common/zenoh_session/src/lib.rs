//! The Zenoh session of a node: settings from a configuration file of Zenoh, from options that
//! override it, and from defaults that keep a machine to itself. Messages from unknown senders are
//! received, counted and rejected in the same way everywhere.
//!
//! Only for the nodes that connect machines; no other crate links Zenoh.

mod error;
mod options;
mod queue;
mod report;
mod routers;
mod session;
pub mod testing;

pub use error::{Cause, KeyError, NetworkError};
pub use options::Options;
pub use queue::{ENVELOPE_BYTES, Past, Queue, QueueLimits, message_bytes};
pub use report::Report;
pub use routers::Routers;
pub use session::{LOG, open, settings};
