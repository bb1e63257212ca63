//! Errors between a device and topic `scan`.

#[derive(Debug, thiserror::Error)]
pub enum LmsError {
    /// The device sent bytes that are no telegram, or a damaged one.
    #[error(transparent)]
    Telegram(#[from] sick::SickError),
    #[error("{address}: cannot {what}")]
    Io {
        address: String,
        what: &'static str,
        source: std::io::Error,
    },
    #[error("{address}: the device closed the connection")]
    Closed { address: String },
    #[error("{address}: no data for {seconds} s; closing the connection")]
    Silent { address: String, seconds: f64 },
    /// Any other problem, in words.
    #[error("{0}")]
    Other(String),
    #[error(transparent)]
    Transport(#[from] transport::TransportError),
}
