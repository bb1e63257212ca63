//! Ground truth of a scan.

use geometry::Pose;
use ros::{ConversionError, PoseStamped};

/// True pose of the laser.
#[derive(Debug, Clone, PartialEq)]
pub struct GroundTruth {
    pub frame: String,
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
