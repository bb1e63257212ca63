//! What can go wrong with the messages of a recording.

use recording::RecordingError;
use ros::ConversionError;

/// What was tried, what was found and what is allowed.
#[derive(Debug, thiserror::Error)]
pub enum PlaybackError {
    /// The recording, or a message of it, cannot be read.
    #[error(transparent)]
    Recording(#[from] Box<RecordingError>),
    /// A message says what the graph cannot.
    #[error("the message of {topic} at log time {log_time_ns} ns cannot be used: {reason}")]
    Message {
        /// The channel.
        topic: String,
        /// Nanoseconds since 1970.
        log_time_ns: i64,
        /// What is wrong.
        reason: ConversionError,
    },
}

impl PlaybackError {
    /// Whether it is about one message, so that the next one may be played.
    #[must_use]
    pub fn is_about_one_message(&self) -> bool {
        match self {
            PlaybackError::Message { .. } => true,
            PlaybackError::Recording(error) => matches!(**error, RecordingError::Message { .. }),
        }
    }

    /// Whether the recording is damaged, so that what lay before has been played.
    #[must_use]
    pub fn is_damage(&self) -> bool {
        match self {
            PlaybackError::Recording(error) => matches!(**error, RecordingError::Damaged { .. }),
            PlaybackError::Message { .. } => false,
        }
    }
}

impl From<RecordingError> for PlaybackError {
    fn from(error: RecordingError) -> Self {
        PlaybackError::Recording(Box::new(error))
    }
}
