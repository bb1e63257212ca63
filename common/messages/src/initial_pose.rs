//! Where an operator or another program says that the robot is.

use bytemuck::{Pod, Zeroable};
use serde::{Deserialize, Serialize};

#[cfg(feature = "iceoryx2")]
use crate::zero_copy::ZeroCopySend;
use crate::{Pose2, Stamp};

/// The message of topic `initial_pose`.
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable, Serialize, Deserialize)]
#[cfg_attr(
    feature = "iceoryx2",
    derive(ZeroCopySend),
    type_name("InitialPose/v1")
)]
#[repr(C)]
pub struct InitialPose {
    /// When it was said.
    pub stamp: Stamp,
    /// Pose of the robot's base in the map; the laser's where no mount is known.
    pub map_from_base: Pose2,
    /// Of that pose, row by row over x, y and yaw: m², m·rad, rad².
    pub covariance: [f64; 9],
}

#[cfg(test)]
mod tests {
    use super::*;
    crate::pin_layout!(InitialPose, size 120, align 8, {
        stamp: 0, map_from_base: 24, covariance: 48,
    });
}
