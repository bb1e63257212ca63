//! One laser scan.

use crate::{FrameName, Name, Pose2, Stamp};

crate::message! {
    #[type_name("ScanHeader/v2")]
    /// Header of topic `scan`; the items are ranges in metres. Beam `i` points to
    /// `angle_min + i · angle_increment` in the laser's frame.
    pub struct ScanHeader {
        /// Stamp of the first beam.
        pub stamp: Stamp,
        /// Bearing of the first beam, in radians counter-clockwise from ahead.
        pub angle_min: f64,
        /// Angle between consecutive beams, in radians; negative if the laser turns clockwise.
        pub angle_increment: f64,
        /// Time between consecutive beams, in seconds; 0 if unknown.
        pub time_increment_s: f64,
        /// Time between consecutive scans, in seconds; 0 if unknown.
        pub scan_time_s: f64,
        /// Readings below this are no returns, in metres.
        pub range_min_m: f32,
        /// Readings at or above this are no returns, in metres.
        pub range_max_m: f32,
        /// Mount of the laser on the robot; identity unless `mount_known`.
        pub base_from_laser: Pose2,
        /// 1 if the mount was given by a transform or the configuration, else 0.
        pub mount_known: u64,
        /// 1 if the laser is mounted upside down (rolled by half a turn about its x axis), so that
        /// seen from above, a beam of bearing b has bearing -b. Else 0.
        pub upside_down: u64,
        /// Name of the laser; empty if the graph has only one.
        pub laser: Name,
        /// Frame of the laser.
        pub frame: FrameName,
    }
}
