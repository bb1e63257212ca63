//! Errors that end the monitor.

#[derive(Debug, thiserror::Error)]
pub enum MonitorError {
    #[error(transparent)]
    Dashboard(#[from] dashboard::DashboardError),
    #[error(transparent)]
    Transport(#[from] transport::TransportError),
}
