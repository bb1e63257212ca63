//! Errors that end the node.

use std::path::PathBuf;

#[derive(Debug, thiserror::Error)]
pub enum MapServerError {
    #[error("the map in the recording {}", path.display())]
    Recorded {
        path: PathBuf,
        source: Box<dyn std::error::Error + Send + Sync>,
    },
    #[error("the recording {} holds no map, and --map names none", path.display())]
    NoMap { path: PathBuf },
    #[error(transparent)]
    Map(#[from] map::MapError),
    #[error(transparent)]
    Transport(#[from] transport::TransportError),
}
