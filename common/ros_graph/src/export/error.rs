//! Errors of the conversion to messages of ROS.

use recording::RecordingError;

/// Reason why a sample cannot be added to a transcript.
#[derive(Debug, thiserror::Error)]
pub enum TranscriptError {
    #[error(
        "topic {topic}: a stamp of {stamp_ns} ns; allowed are 0 to 2147483647999999999, the times \
         of ROS from 1970 on"
    )]
    Stamp {
        topic: &'static str,
        /// Nanoseconds since 1970.
        stamp_ns: i64,
    },
    #[error("topic {topic}: {width} x {height} cells are claimed, {found} are there")]
    Size {
        topic: &'static str,
        width: u32,
        height: u32,
        found: usize,
    },
    #[error("topic map")]
    MapId(#[from] messages::WrongMapId),
    #[error(transparent)]
    Encoding(Box<RecordingError>),
}

impl From<RecordingError> for TranscriptError {
    fn from(error: RecordingError) -> Self {
        TranscriptError::Encoding(Box::new(error))
    }
}

pub(crate) type Result<T = (), E = TranscriptError> = std::result::Result<T, E>;
