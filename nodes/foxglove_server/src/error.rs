//! Errors that end the server.

use std::net::SocketAddr;

use foxglove::FoxgloveError;

/// What was tried, what was found and what is allowed.
#[derive(Debug, thiserror::Error)]
pub enum ServerError {
    /// It cannot listen.
    #[error("cannot listen on {address}; another address is given by --listen")]
    Listen {
        /// The address.
        address: SocketAddr,
        /// What the library says.
        source: FoxgloveError,
    },
    /// There can be no thread for viewers.
    #[error("no thread can be started for viewers")]
    Start(#[source] std::io::Error),
    /// The thread for viewers has failed.
    #[error("the thread that serves viewers has failed; see its panic above")]
    Thread,
    /// A channel cannot be opened.
    #[error("cannot show {topic}")]
    Channel {
        /// The topic of ROS.
        topic: String,
        /// What the library says.
        source: FoxgloveError,
    },
    /// The graph failed.
    #[error(transparent)]
    Transport(#[from] transport::TransportError),
}
