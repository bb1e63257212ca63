//! Errors that end the bridge.

use std::path::PathBuf;

use dataflow::DataflowError;
use network_payload::WireError;
use transport::TransportError;
use zenoh_session::{KeyError, NetworkError};

#[derive(Debug, thiserror::Error)]
pub enum BridgeError {
    #[error("cannot determine which topics go out and come in")]
    Dataflow(#[from] DataflowError),
    #[error("{} has no node {id:?}: allowed are {allowed}", file.display())]
    NoSuchNode {
        file: PathBuf,
        id: String,
        allowed: String,
    },
    #[error(
        "topic {topic} goes out and comes in: it would come back for ever; \
         take it out of the inputs or the outputs of the bridge"
    )]
    Circle { topic: String },
    #[error(transparent)]
    Network(#[from] NetworkError),
    #[error(transparent)]
    Key(#[from] KeyError),
    #[error("cannot draw a random session id")]
    Random(#[source] getrandom::Error),
    #[error(transparent)]
    Map(#[from] map::MapError),
    #[error(transparent)]
    Wire(#[from] WireError),
    #[error(transparent)]
    Transport(#[from] TransportError),
}
