//! Where a particle filter may start.

use bytemuck::{Pod, Zeroable};
use serde::{Deserialize, Serialize};

#[cfg(feature = "iceoryx2")]
use crate::zero_copy::ZeroCopySend;
use crate::{Pose2, Stamp};

/// Header of topic `particles`; the items are poses around the hypotheses of a scan, as
/// many around each as it is likely. None where the scan has no place.
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable, Serialize, Deserialize)]
#[cfg_attr(
    feature = "iceoryx2",
    derive(ZeroCopySend),
    type_name("ParticlesHeader/v1")
)]
#[repr(C)]
pub struct ParticlesHeader {
    /// Of the scan.
    pub stamp: Stamp,
    /// The map that was searched; 0 where there was none.
    pub map_id: u64,
    /// 1 where the laser's mount is known and `map_from_base` is meant, else 0.
    pub mount_known: u64,
}

/// One pose; all weigh the same.
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable, Serialize, Deserialize)]
#[cfg_attr(feature = "iceoryx2", derive(ZeroCopySend), type_name("Particle/v1"))]
#[repr(C)]
pub struct Particle {
    /// Pose of the robot's base in the map; the laser's where no mount is known.
    pub map_from_base: Pose2,
}

#[cfg(test)]
mod tests {
    use super::*;
    crate::pin_layout!(ParticlesHeader, size 40, align 8, {
        stamp: 0, map_id: 24, mount_known: 32,
    });

    mod particle {
        use super::*;
        crate::pin_layout!(Particle, size 24, align 8, { map_from_base: 0 });
    }
}
