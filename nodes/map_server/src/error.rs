//! Errors that end the node.

use std::path::PathBuf;

/// Why the node could not start or go on.
#[derive(Debug, thiserror::Error)]
pub enum MapServerError {
    /// The map in a recording cannot be used.
    #[error("the map in the recording {}", path.display())]
    Recorded {
        /// As configured.
        path: PathBuf,
        /// What is wrong.
        source: Box<dyn std::error::Error + Send + Sync>,
    },
    /// The graph failed.
    #[error(transparent)]
    Transport(#[from] transport::TransportError),
}
