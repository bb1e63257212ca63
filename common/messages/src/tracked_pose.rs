//! Pose from the tracker, and its certainty.

use crate::{FrameName, Pose2, Stamp};

crate::message! {
    #[type_name("PoseHeader/v1")]
    /// The message of topic `pose`; the items are the reason in words and what to do, as UTF-8.
    pub struct PoseHeader {
        /// Stamp of the scan or, between scans, of the odometry.
        pub stamp: Stamp,
        /// Map of the pose; 0 without a map.
        pub map_id: u64,
        /// `CLOCK_MONOTONIC` in nanoseconds when the pose was sent.
        pub sent_ns: i64,
        /// Computing time in nanoseconds, without the search.
        pub tracking_ns: u64,
        /// Start of the current state by the stamps of scans: nanoseconds since 1970.
        pub since_ns: i64,
        /// Distance that the robot has moved since then, in metres.
        pub since_m: f64,
        /// Pose of the laser in the map; of the first one if there are several.
        pub map_from_laser: Pose2,
        /// Pose of the robot's base in the map; the laser's if the mount is unknown.
        pub map_from_base: Pose2,
        /// Pose of the odometry's frame in the map; valid if `odom_known` is 1.
        pub map_from_odom: Pose2,
        /// Covariance of `map_from_laser`, row by row over x, y and yaw: m², m·rad, rad².
        pub laser_covariance: [f64; 9],
        /// Covariance of `map_from_base`, row by row over x, y and yaw: m², m·rad, rad².
        pub base_covariance: [f64; 9],
        /// Probability of the pose, 0..=1.
        pub probability: f64,
        /// Natural logarithm of the odds of that probability.
        pub lead: f64,
        /// Fit of the last scan to the map at the pose, at most 1.
        pub score: f64,
        /// State of the tracker, a [`TrackState`].
        pub state: u32,
        /// Reason for the state, a [`TrackReason`].
        pub reason: u32,
        /// Number of places that are kept as possible, including the best.
        pub places: u32,
        /// 1 if the pose is that of a scan, 0 if odometry has moved it on since.
        pub from_scan: u32,
        /// 1 if there is a pose: that of the believed place, else of the leading one.
        pub pose_known: u32,
        /// 1 if the laser's mount is known and `map_from_base` is valid, else 0.
        pub mount_known: u32,
        /// 1 if odometry is known and `map_from_odom` is valid, else 0.
        pub odom_known: u64,
        /// Frame of the odometry, if it is known.
        pub odom_frame: FrameName,
    }
}

impl PoseHeader {
    /// Longest reason in words, in bytes.
    pub const WORDS_CAPACITY: usize = 256;

    /// Returns the pose of the laser in the map, if there is one.
    #[must_use]
    pub fn laser(&self) -> Option<Pose2> {
        let pose = Some(self.map_from_laser).filter(|_| self.pose_known == 1);
        pose.filter(|&pose| geometry::Pose::from(pose).is_finite())
    }

    /// Returns the pose of the base in the map, if there is one and the laser's mount is known.
    #[must_use]
    pub fn base(&self) -> Option<Pose2> {
        let pose = self.laser().map(|_| self.map_from_base);
        pose.filter(|&pose| self.mount_known == 1 && geometry::Pose::from(pose).is_finite())
    }

    /// True if there is a pose and the tracker believes it.
    #[must_use]
    pub fn is_believed(&self) -> bool {
        let state = TrackState::from_code(self.state);
        self.pose_known == 1 && state.is_some_and(TrackState::is_believed)
    }

    /// True if there is a pose and nothing contradicts it.
    #[must_use]
    pub fn is_unique(&self) -> bool {
        self.pose_known == 1 && self.state == TrackState::Unique as u32
    }
}

crate::codes! {
    /// State of the tracker.
    pub enum TrackState: u32 {
        /// The robot has not been found yet.
        Searching = 0 => "Searching",
        /// One place is left, and the scans fit there.
        Unique = 1 => "Unique",
        /// The pose is kept, but something contradicts it.
        Doubtful = 2 => "Doubtful",
        /// The robot was found before, but scans say that it is no longer at the pose.
        Lost = 3 => "Lost",
    }
}

impl TrackState {
    /// True if the tracker believes a place.
    #[must_use]
    pub fn is_believed(self) -> bool {
        matches!(self, Self::Unique | Self::Doubtful)
    }
}

crate::codes! {
    /// Reason for the state of the tracker.
    pub enum TrackReason: u32 {
        /// No scan has been answered yet.
        NoScan = 0,
        /// No map has been received yet.
        NoMap = 1,
        /// One place leads clearly, and the scan fits there.
        OnePlace = 2,
        /// Several places fit.
        SeveralPlaces = 3,
        /// One place leads, but not by enough yet.
        TooEarly = 4,
        /// The scan does not fit at the expected pose.
        PoorFit = 5,
        /// Laser and odometry disagree about the motion of the robot.
        OdometryJump = 6,
        /// Scans fit better at another place.
        AnotherPlace = 7,
        /// No place on the map fits.
        NoPlace = 8,
        /// No search has been answered yet.
        NoSearch = 9,
    }
}
