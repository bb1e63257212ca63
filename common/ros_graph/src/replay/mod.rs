//! Building blocks of nodes that replay a recording.
//!
//! `selection` defines the part to replay, `source` and `convert` turn records into messages,
//! `order` moves messages that belong to a scan before it, `schedule` decides when each is due and
//! which answer to wait for, and `readiness` tracks which nodes are ready; all of these do no I/O.
//! `poses` publishes messages other than scans, and `waiting` waits for nodes. Publishing scans is
//! left to the node. Ranges are passed on exactly as they were recorded.

mod error;
mod order;
mod poses;
mod rate;
mod readiness;
mod schedule;
mod selection;
mod source;
mod waiting;

pub use error::PlaybackError;
pub use order::InOrder;
pub use poses::Poses;
pub use rate::Rate;
pub use schedule::{Action, Schedule};
pub use selection::{Remap, Selection};
pub use source::{Channels, Content, Source, Timed};
pub use waiting::{Awaited, wait_for_nodes};
