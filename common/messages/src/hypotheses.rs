//! Candidate poses of the robot.

use crate::{Pose2, Stamp};

crate::message! {
    #[type_name("HypothesesHeader/v5")]
    /// Header of topic `hypotheses`; the items are distinct poses, best first.
    pub struct HypothesesHeader {
        /// Stamp of the scan.
        pub stamp: Stamp,
        /// Map that was searched; of several, the map of the best hypothesis; 0 without a map.
        pub map_id: u64,
        /// `CLOCK_MONOTONIC` in nanoseconds when the hypotheses were sent.
        pub sent_ns: i64,
        /// Computing time from scan to votes, in nanoseconds.
        pub search_ns: u64,
        /// Computing time from votes to hypotheses, in nanoseconds.
        pub extract_ns: u64,
        /// Verdict on the scan, a [`Verdict`].
        pub verdict: u32,
        /// Number of other places that fit about as well as the best; 0 if it is unique.
        pub alternatives: u32,
        /// Probability of the best pose, 0..=1.
        pub confidence: f32,
        /// Share of the beams' weight that agrees with the best pose, 0..=1.
        pub inlier_share: f32,
        /// Highest intensity of any pose.
        pub best: u32,
        /// Intensity of a pose that agrees with every beam.
        pub highest_possible: u32,
        /// 1 if the laser's mount is known and `map_from_base` is valid, else 0.
        pub mount_known: u64,
        /// Id of what was searched, see [`searched_id`](crate::searched_id): the map's id, or for a
        /// set an id of all its maps; 0 without a search. It tells a search without a result from
        /// no search.
        pub searched: u64,
        /// Id of the settings by which scans are read and compared with the map.
        pub settings: u64,
    }

    #[type_name("Hypothesis/v3")]
    /// A candidate pose of the robot.
    pub struct Hypothesis {
        /// Pose of the laser in the map.
        pub map_from_laser: Pose2,
        /// Pose of the robot's base in the map; the laser's if the mount is unknown.
        pub map_from_base: Pose2,
        /// Covariance of `map_from_laser`, row by row over x, y and yaw: m², m·rad, rad².
        pub covariance: [f64; 9],
        /// Fit of the scan to the map at this pose, at most 1; for a place too far behind the best
        /// to matter, an upper bound of the fit.
        pub score: f32,
        /// Probability of the pose, 0..=1. The rest of the sum over all hypotheses is the
        /// probability of none of them.
        pub probability: f32,
        /// Intensity of the best search pose that led to this hypothesis.
        pub intensity: u64,
        /// Number of search poses that led to this hypothesis.
        pub support: u64,
        /// Map of `map_from_laser`.
        pub map_id: u64,
    }
}

impl HypothesesHeader {
    /// Returns the hypotheses on the best one's map, for receivers that know only one map.
    pub fn on_map<'a>(
        &self,
        places: &'a [Hypothesis],
    ) -> impl Iterator<Item = &'a Hypothesis> + Clone + use<'a> {
        let map_id = self.map_id;
        places.iter().filter(move |place| place.map_id == map_id)
    }
}

crate::codes! {
    /// Conclusion from a scan about the pose.
    #[derive(Default)]
    pub enum Verdict: u32 {
        /// There are no usable beams: the scan was empty, was rejected, or does not match the map at
        /// all.
        #[default]
        NoScan = 0 => "NoScan",
        /// One place fits, and no other fits nearly as well.
        Unique = 1 => "Unique",
        /// Several places fit about as well.
        Ambiguous = 2 => "Ambiguous",
        /// Even the best place fits badly: the map may be wrong.
        PoorFit = 3 => "PoorFit",
    }
}
