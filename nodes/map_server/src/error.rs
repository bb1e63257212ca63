//! Errors that end the node.

use std::path::PathBuf;

/// Why the node could not start or go on.
#[derive(Debug, thiserror::Error)]
pub enum MapServerError {
    /// There is no usable map to start with.
    #[error("map {}", path.display())]
    Map {
        /// As configured.
        path: PathBuf,
        /// What is wrong, where, and what is allowed.
        source: Box<map::MapError>,
    },
    /// The graph failed.
    #[error(transparent)]
    Transport(#[from] transport::TransportError),
}
