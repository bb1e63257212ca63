//! Errors that end the server.

use std::net::SocketAddr;

use foxglove::FoxgloveError;

#[derive(Debug, thiserror::Error)]
pub enum ServerError {
    #[error("cannot listen on {address}; another address is given by --listen")]
    Listen {
        address: SocketAddr,
        source: FoxgloveError,
    },
    #[error("no thread can be started for viewers")]
    Start(#[source] std::io::Error),
    #[error("the thread that serves viewers has failed; see its panic above")]
    Thread,
    #[error("cannot show {topic}")]
    Channel {
        topic: String,
        source: FoxgloveError,
    },
    #[error(transparent)]
    Transport(#[from] transport::TransportError),
}
