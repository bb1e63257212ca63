//! The true pose of a scan, as recordings made for evaluation hold it.

use bytemuck::{Pod, Zeroable};
use serde::{Deserialize, Serialize};

#[cfg(feature = "iceoryx2")]
use crate::zero_copy::ZeroCopySend;
use crate::{FrameName, Pose2, Stamp};

/// The message of topic `ground_truth`; its `measured_ns` is the scan's.
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable, Serialize, Deserialize)]
#[cfg_attr(
    feature = "iceoryx2",
    derive(ZeroCopySend),
    type_name("GroundTruth/v2")
)]
#[repr(C)]
pub struct GroundTruth {
    /// Of the scan that it belongs to.
    pub stamp: Stamp,
    /// Pose of the laser in the map.
    pub map_from_laser: Pose2,
    /// The frame in which the pose is given.
    pub frame: FrameName,
}

#[cfg(test)]
mod tests {
    use super::*;
    crate::pin_layout!(GroundTruth, size 304, align 8, { stamp: 0, map_from_laser: 24, frame: 48 });
}
