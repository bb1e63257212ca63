//! A pose in a message.

use bytemuck::{Pod, Zeroable};
use geometry::Pose;
use serde::{Deserialize, Serialize};

#[cfg(feature = "iceoryx2")]
use crate::zero_copy::ZeroCopySend;

/// A pose in metres and radians; the name of its field gives the frames.
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable, Serialize, Deserialize)]
#[cfg_attr(feature = "iceoryx2", derive(ZeroCopySend), type_name("Pose2/v1"))]
#[repr(C)]
pub struct Pose2 {
    /// Position along x in metres.
    pub x: f64,
    /// Position along y in metres.
    pub y: f64,
    /// Heading in radians, counter-clockwise.
    pub yaw: f64,
}

impl From<Pose> for Pose2 {
    fn from(Pose { x, y, yaw }: Pose) -> Self {
        Pose2 { x, y, yaw }
    }
}

impl From<Pose2> for Pose {
    fn from(Pose2 { x, y, yaw }: Pose2) -> Self {
        Pose::new(x, y, yaw)
    }
}
