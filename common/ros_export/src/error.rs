//! Why a sample has no place in a transcript.

use recording::RecordingError;

/// What was found and what is allowed.
#[derive(Debug, thiserror::Error)]
pub enum TranscriptError {
    /// A time that no message of ROS can say.
    #[error(
        "topic {topic}: a stamp of {stamp_ns} ns; allowed are 0 to 2147483647999999999, the times \
         of ROS from 1970 on"
    )]
    Stamp {
        /// The topic in the graph.
        topic: &'static str,
        /// Nanoseconds since 1970.
        stamp_ns: i64,
    },
    /// A sample whose header and items contradict each other.
    #[error("topic {topic}: {width} x {height} cells are claimed, {found} are there")]
    Size {
        /// The topic in the graph.
        topic: &'static str,
        /// Cells along x.
        width: u32,
        /// Cells along y.
        height: u32,
        /// Items of the sample.
        found: usize,
    },
    /// A map that is not the one that its id says.
    #[error("topic map")]
    MapId(#[from] messages::WrongMapId),
    /// It cannot be said in CDR.
    #[error(transparent)]
    Encoding(Box<RecordingError>),
}

impl From<RecordingError> for TranscriptError {
    fn from(error: RecordingError) -> Self {
        TranscriptError::Encoding(Box::new(error))
    }
}
