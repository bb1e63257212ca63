//! Initial particles for a particle filter.

use bytemuck::{Pod, Zeroable};
use serde::{Deserialize, Serialize};

#[cfg(feature = "iceoryx2")]
use crate::zero_copy::ZeroCopySend;
use crate::{Pose2, Stamp};

/// Header of topic `particles`; the items are poses around the hypotheses of a scan, their number
/// in proportion to the probability of each. There are none if the scan has no hypothesis.
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable, Serialize, Deserialize)]
#[cfg_attr(
    feature = "iceoryx2",
    derive(ZeroCopySend),
    type_name("ParticlesHeader/v1")
)]
#[repr(C)]
pub struct ParticlesHeader {
    /// Stamp of the scan.
    pub stamp: Stamp,
    /// Map that was searched; 0 without a map.
    pub map_id: u64,
    /// 1 if the laser's mount is known and `map_from_base` is valid, else 0.
    pub mount_known: u64,
}

/// One pose; all have the same weight.
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable, Serialize, Deserialize)]
#[cfg_attr(feature = "iceoryx2", derive(ZeroCopySend), type_name("Particle/v1"))]
#[repr(C)]
pub struct Particle {
    /// Pose of the robot's base in the map; the laser's if the mount is unknown.
    pub map_from_base: Pose2,
}
