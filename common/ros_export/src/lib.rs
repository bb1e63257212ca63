//! What flows in the graph, as messages of ROS with their times: what a recorder
//! writes, and a viewer is shown.
//!
//! | file | what it is about |
//! |---|---|
//! | `inputs` | the topics of the graph, each with what was missed of it |
//! | `entries` | from samples of the graph to messages of ROS, each with its time; pure |
//! | `topics` | what the messages of ROS are called |
//! | `transcript` | what was made, lost and refused |

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
