//! Comparison of each beam of a scan with the map.

use crate::{Pose2, Stamp};

crate::message! {
    #[type_name("BeamsHeader/v1")]
    /// Header of topic `beams`; the items are the beams that voted, by bearing, followed by those
    /// without a return.
    pub struct BeamsHeader {
        /// Stamp of the scan.
        pub stamp: Stamp,
        /// Map that the beams were compared with; 0 without a map.
        pub map_id: u64,
        /// Pose of the laser in the map for the comparison: the best hypothesis.
        pub map_from_laser: Pose2,
    }

    #[type_name("Beam/v1")]
    /// One beam of a scan.
    pub struct Beam {
        /// Bearing in the laser's frame, in radians counter-clockwise from ahead.
        pub bearing: f32,
        /// Range in metres; infinity without a return.
        pub range_m: f32,
        /// Weight of the vote, 0..=1.05; 0 without a return.
        pub weight: f32,
        /// Result of the comparison, a [`BeamFate`].
        pub fate: u32,
    }
}

crate::codes! {
    /// Result of comparing a beam with the map.
    pub enum BeamFate: u32 {
        /// It ends at an obstacle of the map.
        Hit = 0,
        /// It ends in free space: at an object that is not in the map.
        Short = 1,
        /// It passes through an obstacle of the map.
        Through = 2,
        /// It ends behind unknown space, where it cannot be compared.
        Unknown = 3,
        /// It has no return, or one from beyond the map.
        NoReturn = 4,
    }
}
