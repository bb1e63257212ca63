//! Errors that end the monitor.

/// Error of the node, with the value found and the values allowed.
#[derive(Debug, thiserror::Error)]
pub enum MonitorError {
    #[error(transparent)]
    Dashboard(#[from] dashboard::DashboardError),
    #[error(transparent)]
    Transport(#[from] transport::TransportError),
}
