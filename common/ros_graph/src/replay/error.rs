//! Errors of replaying a recording.

use recording::RecordingError;
use ros::ConversionError;

/// Error of a recording or one of its messages.
#[derive(Debug, thiserror::Error)]
pub enum PlaybackError {
    #[error(transparent)]
    Recording(#[from] Box<RecordingError>),
    #[error("the message of {topic} at log time {log_time_ns} ns cannot be used: {reason}")]
    Message {
        topic: String,
        /// Nanoseconds since 1970.
        log_time_ns: i64,
        reason: ConversionError,
    },
}

impl PlaybackError {
    /// True if the error concerns one message, so that the next one can be replayed.
    pub fn is_about_one_message(&self) -> bool {
        match self {
            PlaybackError::Message { .. } => true,
            PlaybackError::Recording(error) => matches!(**error, RecordingError::Message { .. }),
        }
    }

    /// True if the recording is damaged; everything before the damage has been replayed.
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
