//! Errors that end the gateway, and reasons to reject a message.

use ros::ConversionError;
use transport::TransportError;
use zenoh_session::{KeyError, NetworkError};

/// Error of the gateway: says what was tried, what was found and what is allowed.
#[derive(Debug, thiserror::Error)]
pub enum GatewayError {
    #[error("--{option}: {reason}")]
    Option {
        option: &'static str,
        reason: String,
    },
    #[error("{0}")]
    Refused(String),
    #[error(transparent)]
    Network(#[from] NetworkError),
    #[error(transparent)]
    Key(#[from] KeyError),
    #[error(transparent)]
    Output(#[from] command_line::OutputError),
    #[error(transparent)]
    Conversion(#[from] ConversionError),
    #[error(transparent)]
    Transport(#[from] TransportError),
}

impl GatewayError {
    /// Returns a function that converts an error of writing a message for `topic`.
    pub(crate) fn encoding<E: std::fmt::Display>(topic: &str) -> impl FnOnce(E) -> Self {
        move |error| {
            Self::Refused(format!(
                "the message for {topic} cannot be written: {error}"
            ))
        }
    }

    /// Returns a function that converts the reason why a message of `topic` cannot be read.
    pub(crate) fn decoding<E: std::fmt::Display>(topic: &str) -> impl FnOnce(E) -> Self {
        move |reason| Self::Refused(format!("the message of {topic} cannot be read: {reason}"))
    }

    /// Returns a function that converts an error of sending a message for `topic`.
    pub(crate) fn sending<E: std::fmt::Display>(topic: &str) -> impl FnOnce(E) -> Self {
        move |error| Self::Refused(format!("the message for {topic} cannot be sent: {error}"))
    }

    pub(crate) fn too_long(topic: &str, found: usize, most: usize) -> Self {
        Self::Refused(format!(
            "the message of {topic} has {found} bytes: allowed are at most {most}"
        ))
    }

    /// Converts a publisher of a topic, which it publishes in another way than the `expected` one.
    pub(crate) fn stranger(node: &str, topic: &str, found: &str, expected: &str) -> Self {
        Self::Refused(format!(
            "{node} publishes {topic} as {found}, which is not supported: expected is {expected}"
        ))
    }
}
