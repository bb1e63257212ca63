//! Errors that end the fleet monitor, and reasons to reject a message.

use dashboard::{DashboardError, Robots};
use network_payload::WireError;
use transport::TransportError;
use zenoh_session::{KeyError, NetworkError};

#[derive(Debug, thiserror::Error)]
pub enum FleetError {
    #[error(transparent)]
    Dashboard(#[from] DashboardError),
    #[error(transparent)]
    Network(#[from] NetworkError),
    #[error(transparent)]
    Key(#[from] KeyError),
    #[error("cannot draw a random session id")]
    Random(#[source] getrandom::Error),
    #[error(transparent)]
    Wire(#[from] WireError),
    #[error(
        "there are {} robots, which is the maximum; {robot} is ignored",
        Robots::MAX
    )]
    TooMany { robot: String },
    #[error("{problem} of {robot}")]
    Unusable {
        problem: &'static str,
        robot: String,
    },
    #[error(transparent)]
    Transport(#[from] TransportError),
}
