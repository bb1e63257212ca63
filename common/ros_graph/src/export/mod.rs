//! Converts the topics of the graph to messages of ROS with their times, for recorders and viewers.
//!
//! | file | content |
//! |---|---|
//! | `inputs` | subscribers of the graph's topics, with counts of missed samples |
//! | `entries` | conversion of samples to messages of ROS with their times; no I/O |
//! | `topics` | names of the topics in ROS |
//! | `transcript` | entries made, and counts of lost and rejected samples |

mod entries;
mod error;
mod inputs;
mod options;
pub mod topics;
mod transcript;

pub use entries::{Entries, Entry};
pub use error::TranscriptError;
pub use inputs::{Inputs, Listener};
pub use options::Options;
pub use transcript::Transcript;
