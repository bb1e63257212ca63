//! True pose of a scan, from recordings made for evaluation.

use crate::{FrameName, Pose2, Stamp};

crate::message! {
    #[type_name("GroundTruth/v2")]
    /// The message of topic `ground_truth`.
    pub struct GroundTruth {
        /// Stamp of the scan; its `measured_ns` is that of the scan.
        pub stamp: Stamp,
        /// Pose of the laser in the map.
        pub map_from_laser: Pose2,
        /// Frame of the pose.
        pub frame: FrameName,
    }
}
