//! Errors that end the fleet monitor, and reasons to reject a message.

use dashboard::{DashboardError, Robots};
use network_payload::WireError;
use transport::TransportError;
use zenoh_session::{KeyError, NetworkError};

/// What was tried, what was found and what is allowed.
#[derive(Debug, thiserror::Error)]
pub enum FleetError {
    /// The page cannot be served.
    #[error(transparent)]
    Dashboard(#[from] DashboardError),
    /// The session cannot be opened.
    #[error(transparent)]
    Network(#[from] NetworkError),
    /// A key cannot be used.
    #[error(transparent)]
    Key(#[from] KeyError),
    /// The system gives no random number.
    #[error("cannot draw a random session id")]
    Random(#[source] getrandom::Error),
    /// A message is invalid, or a robot's name is invalid.
    #[error(transparent)]
    Wire(#[from] WireError),
    /// There are as many robots already as may be.
    #[error(
        "there are {} robots, which is the maximum; {robot} is ignored",
        Robots::MAX
    )]
    TooMany {
        /// The one that is.
        robot: String,
    },
    /// A message contradicts itself in a way that shows only here.
    #[error("{problem} of {robot}")]
    Unusable {
        /// What it is.
        problem: &'static str,
        /// Whose.
        robot: String,
    },
    /// The graph of this machine fails.
    #[error(transparent)]
    Transport(#[from] TransportError),
}
