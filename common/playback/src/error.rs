//! What can go wrong with the messages of a recording.

use recording::RecordingError;
use recording::ros::ConversionError;

/// What was tried, what was found and what is allowed.
#[derive(Debug, thiserror::Error)]
pub enum PlaybackError {
    /// The recording, or a message of it, cannot be read.
    #[error(transparent)]
    Recording(#[from] Box<RecordingError>),
    /// A frame's name does not fit into a message.
    #[error(
        "the message of {topic} at log time {log_time_ns} ns: the frame {frame:?} has {} bytes, \
         at most {} are allowed", frame.len(), messages::Name::CAPACITY
    )]
    Frame {
        /// The channel.
        topic: String,
        /// Nanoseconds since 1970.
        log_time_ns: i64,
        /// The name.
        frame: String,
    },
    /// A pose is none.
    #[error("the message of {topic} at log time {log_time_ns} ns cannot be used: {reason}")]
    Pose {
        /// The channel.
        topic: String,
        /// Nanoseconds since 1970.
        log_time_ns: i64,
        /// What is wrong.
        reason: Box<ConversionError>,
    },
}

impl PlaybackError {
    /// Whether it is about one message, so that the next one may be played.
    #[must_use]
    pub fn is_about_one_message(&self) -> bool {
        match self {
            PlaybackError::Frame { .. } | PlaybackError::Pose { .. } => true,
            PlaybackError::Recording(error) => matches!(**error, RecordingError::Message { .. }),
        }
    }

    /// Whether the recording is damaged, so that what lay before has been played.
    #[must_use]
    pub fn is_damage(&self) -> bool {
        match self {
            PlaybackError::Recording(error) => matches!(**error, RecordingError::Damaged { .. }),
            PlaybackError::Frame { .. } | PlaybackError::Pose { .. } => false,
        }
    }
}

impl From<RecordingError> for PlaybackError {
    fn from(error: RecordingError) -> Self {
        PlaybackError::Recording(Box::new(error))
    }
}
