//! What every node that plays a recording needs.
//!
//! `selection` says what is played of it, `source` and `convert` turn records into
//! messages, `order` sees to it that what belongs to a scan comes before it,
//! `schedule` says when each is due and which answer is waited for, `readiness` who
//! is ready; all pure. `poses` sends what is no scan, and `waiting` waits for nodes.
//! How a scan reaches the graph is left to the node. Readings are passed on as
//! they were recorded, however odd.

mod convert;
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
