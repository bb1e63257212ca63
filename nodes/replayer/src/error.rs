//! What can go wrong with a recording and on the way into the graph.

use std::path::PathBuf;

use recording::RecordingError;
use recording::ros::ConversionError;

/// What was tried, what was found and what is allowed.
#[derive(Debug, thiserror::Error)]
pub enum ReplayerError {
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
    /// Topics that were asked for are not there.
    #[error("{} has no {}; it has {}", path.display(), unknown.join(", "), found.join(", "))]
    UnknownTopics {
        /// The recording.
        path: PathBuf,
        /// Of --topics and --remap.
        unknown: Vec<String>,
        /// The recording's channels.
        found: Vec<String>,
    },
    /// Standard input cannot be read.
    #[error("cannot read what is typed")]
    Keyboard(#[source] std::io::Error),
    /// The graph failed.
    #[error(transparent)]
    Transport(#[from] transport::TransportError),
}

impl ReplayerError {
    /// Whether it is about one message, so that the next one may be played.
    pub(crate) fn is_about_one_message(&self) -> bool {
        match self {
            ReplayerError::Frame { .. } | ReplayerError::Pose { .. } => true,
            ReplayerError::Recording(error) => matches!(**error, RecordingError::Message { .. }),
            ReplayerError::UnknownTopics { .. }
            | ReplayerError::Keyboard(_)
            | ReplayerError::Transport(_) => false,
        }
    }
}

impl ReplayerError {
    /// Whether the recording is damaged, so that what lay before has been played.
    pub(crate) fn is_damage(&self) -> bool {
        match self {
            ReplayerError::Recording(error) => matches!(**error, RecordingError::Damaged { .. }),
            _ => false,
        }
    }
}

impl From<RecordingError> for ReplayerError {
    fn from(error: RecordingError) -> Self {
        ReplayerError::Recording(Box::new(error))
    }
}
