//! Errors that end the monitor.

/// What was tried, what was found and what is allowed.
#[derive(Debug, thiserror::Error)]
pub enum MonitorError {
    /// The page cannot be served.
    #[error(transparent)]
    Dashboard(#[from] dashboard::DashboardError),
    /// The graph failed.
    #[error(transparent)]
    Transport(#[from] transport::TransportError),
}
