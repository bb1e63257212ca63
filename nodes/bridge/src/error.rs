//! Errors that end the bridge.

use std::path::PathBuf;

use dataflow::DataflowError;
use network_payload::WireError;
use transport::TransportError;
use zenoh_session::{KeyError, NetworkError};

/// What was tried, what was found and what is allowed.
#[derive(Debug, thiserror::Error)]
pub enum BridgeError {
    /// The descriptor cannot be used.
    #[error("cannot determine which topics go out and come in")]
    Dataflow(#[from] DataflowError),
    /// The descriptor has no such node.
    #[error("{} has no node {id:?}: allowed are {allowed}", file.display())]
    NoSuchNode {
        /// The descriptor.
        file: PathBuf,
        /// The id that was looked for.
        id: String,
        /// The ids that are there.
        allowed: String,
    },
    /// A topic would loop.
    #[error(
        "topic {topic} goes out and comes in: it would come back for ever; \
         take it out of the inputs or the outputs of the bridge"
    )]
    Circle {
        /// The topic.
        topic: String,
    },
    /// The session cannot be opened.
    #[error(transparent)]
    Network(#[from] NetworkError),
    /// A key cannot be used.
    #[error(transparent)]
    Key(#[from] KeyError),
    /// The system gives no random number.
    #[error("cannot draw a random session id")]
    Random(#[source] getrandom::Error),
    /// A map that the graph could not hold.
    #[error(transparent)]
    Map(#[from] map::MapError),
    /// A message cannot leave or enter.
    #[error(transparent)]
    Wire(#[from] WireError),
    /// The graph fails.
    #[error(transparent)]
    Transport(#[from] TransportError),
}
