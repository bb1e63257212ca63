//! True pose of a scan, from recordings made for evaluation.

use bytemuck::{Pod, Zeroable};
use serde::{Deserialize, Serialize};

#[cfg(feature = "iceoryx2")]
use crate::zero_copy::ZeroCopySend;
use crate::{FrameName, Pose2, Stamp};

/// The message of topic `ground_truth`.
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable, Serialize, Deserialize)]
#[cfg_attr(
    feature = "iceoryx2",
    derive(ZeroCopySend),
    type_name("GroundTruth/v2")
)]
#[repr(C)]
pub struct GroundTruth {
    /// Stamp of the scan; its `measured_ns` is that of the scan.
    pub stamp: Stamp,
    /// Pose of the laser in the map.
    pub map_from_laser: Pose2,
    /// Frame of the pose.
    pub frame: FrameName,
}
