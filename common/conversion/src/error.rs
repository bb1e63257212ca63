//! What a message cannot say.

use messages::FrameName;
use recording::ros::ConversionError;

/// What was found, and what is allowed.
#[derive(Debug, thiserror::Error)]
pub enum Unsayable {
    /// A frame's name does not fit into a message of the graph.
    #[error(
        "the frame {frame:?} has {} bytes, at most {} are allowed", frame.len(), FrameName::CAPACITY
    )]
    Frame {
        /// The name.
        frame: String,
    },
    /// A pose is none.
    #[error(transparent)]
    Pose(#[from] Box<ConversionError>),
}

impl From<ConversionError> for Unsayable {
    fn from(error: ConversionError) -> Self {
        Unsayable::Pose(Box::new(error))
    }
}
