//! The Zenoh session of a node, as a user sets it: a file in Zenoh's own words,
//! options on top, and below both what keeps a machine to itself.
//!
//! For the nodes that join machines; nothing else links Zenoh.

mod error;
mod options;
mod session;

pub use error::{Cause, NetworkError};
pub use options::Options;
pub use session::{LOG, open, settings};
