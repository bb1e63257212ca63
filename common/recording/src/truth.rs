//! True poses.

use geometry::Pose;
use ros::{ConversionError, PoseStamped};

/// Where the laser truly was.
#[derive(Debug, Clone, PartialEq)]
pub struct GroundTruth {
    /// The frame in which the pose is given.
    pub frame: String,
    /// The pose of the laser there.
    pub pose: Pose,
}

impl GroundTruth {
    pub(crate) fn of(message: &PoseStamped) -> Result<Self, ConversionError> {
        Ok(GroundTruth {
            frame: message.header.frame_id.clone(),
            pose: message.pose.planar()?,
        })
    }
}
