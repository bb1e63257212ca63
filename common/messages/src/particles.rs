//! Initial particles for a particle filter.

use crate::{Pose2, Stamp};

crate::message! {
    #[type_name("ParticlesHeader/v1")]
    /// Header of topic `particles`; the items are poses around the hypotheses of a scan, their
    /// number in proportion to the probability of each. There are none if the scan has no
    /// hypothesis.
    pub struct ParticlesHeader {
        /// Stamp of the scan.
        pub stamp: Stamp,
        /// Map that was searched; 0 without a map.
        pub map_id: u64,
        /// 1 if the laser's mount is known and `map_from_base` is valid, else 0.
        pub mount_known: u64,
    }

    #[type_name("Particle/v1")]
    /// One pose; all have the same weight.
    pub struct Particle {
        /// Pose of the robot's base in the map; the laser's if the mount is unknown.
        pub map_from_base: Pose2,
    }
}
