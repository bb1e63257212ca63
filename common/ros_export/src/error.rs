//! Errors of the conversion to messages of ROS.

use recording::RecordingError;

/// Reason why a sample cannot be added to a transcript.
#[derive(Debug, thiserror::Error)]
pub enum TranscriptError {
    /// A time that messages of ROS cannot represent.
    #[error(
        "topic {topic}: a stamp of {stamp_ns} ns; allowed are 0 to 2147483647999999999, the times \
         of ROS from 1970 on"
    )]
    Stamp {
        /// Topic in the graph.
        topic: &'static str,
        /// Nanoseconds since 1970.
        stamp_ns: i64,
    },
    /// A sample whose header and items contradict each other.
    #[error("topic {topic}: {width} x {height} cells are claimed, {found} are there")]
    Size {
        /// Topic in the graph.
        topic: &'static str,
        width: u32,
        height: u32,
        /// Number of items in the sample.
        found: usize,
    },
    /// A map that does not have its claimed id.
    #[error("topic map")]
    MapId(#[from] messages::WrongMapId),
    /// A sample that cannot be encoded in CDR.
    #[error(transparent)]
    Encoding(Box<RecordingError>),
}

impl From<RecordingError> for TranscriptError {
    fn from(error: RecordingError) -> Self {
        TranscriptError::Encoding(Box::new(error))
    }
}
