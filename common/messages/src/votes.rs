//! Result of one search: the poses that the scan votes for.

use crate::{Pose2, Stamp};

crate::message! {
    #[type_name("VotesHeader/v7")]
    /// Header of topic `votes`; the items are poses by falling intensity, equal ones by (heading,
    /// y, x): all at or above `certified_floor`, and distinct candidates below. If several maps
    /// were searched, the poses of each map follow in turn.
    pub struct VotesHeader {
        /// Stamp of the scan.
        pub stamp: Stamp,
        /// Map that was searched; 0 without a map.
        pub map_id: u64,
        /// Number of items.
        pub total: u64,
        /// Computing time from scan to votes, in nanoseconds.
        pub engine_ns: u64,
        /// Number of poses whose intensity was computed individually.
        pub poses_evaluated: u64,
        /// Outcome of the search, a [`SearchOutcome`].
        pub outcome: u32,
        /// Number of headings in a full turn; heading `h` is `2π h / headings` in the grid's frame.
        pub headings: u32,
        /// Lowest intensity among the items; 0 without items.
        pub floor: u32,
        /// Intensity at and above which the items are complete.
        pub certified_floor: u32,
        /// Highest intensity of any pose.
        pub best: u32,
        /// Intensity of a pose that agrees with every beam.
        pub highest_possible: u32,
        /// 1 if the floor was raised so that the items fit; [`VotesHeader::CUT`] if the search
        /// exceeded its work limit, so that poses below the certified floor may be missing, which
        /// can be above the best; else 0.
        pub truncated: u32,
        /// Number of beams that voted.
        pub beams_used: u32,
        /// 1 if the heading was given and only x and y were searched, else 0.
        pub heading_known: u32,
        /// Number of beams without a usable reading: no return, too near or too far.
        pub beams_silent: u32,
        /// Given heading in the map frame, in radians; 0 if it was searched.
        pub known_heading: f64,
        /// Largest rounding of a bearing to the heading grid, in radians.
        pub bearing_rounding: f64,
        /// Mount of the laser on the robot; identity unless `mount_known`.
        pub base_from_laser: Pose2,
        /// 1 if the mount was given, else 0.
        pub mount_known: u64,
        /// Largest number of beams of a scan that vote; longer scans are thinned by arc.
        pub max_beams: u32,
        /// Downsampling factor: map cells per search cell and axis. Items are in search cells.
        pub pooling: u32,
        /// Arc at the reading from which a beam has full weight, in metres.
        pub beam_arc_m: f64,
        /// 1 if topic `readings` has the readings for the second stage, because the scan was joined
        /// from several lasers or motion-corrected. Else 0.
        pub has_readings: u32,
        /// Number of lasers that the scan was joined from.
        pub lasers_used: u32,
        /// Number of maps that were searched together. Their votes follow each other in the order
        /// of topic `votes_by_map`, whose items have for each map what this header has for the
        /// leading map. 0 if one map was searched alone.
        pub maps: u64,
        /// Id of what was searched, see [`searched_id`](crate::searched_id): the map's id, or for a
        /// set an id of all its maps; 0 without a search.
        pub searched: u64,
        /// Id of the settings by which scans are joined, deskewed and thinned.
        pub settings: u64,
    }

    #[type_name("VotesByMapHeader/v1")]
    /// Header of topic `votes_by_map`: assigns the votes of a scan to maps. The items are the
    /// headers that the votes of each map would have alone; `total` is their number.
    #[derive(Eq)]
    pub struct VotesByMapHeader {
        /// Stamp of the scan.
        pub stamp: Stamp,
    }

    #[type_name("Vote/v1")]
    /// A pose of the search grid and its intensity.
    #[derive(Eq, Hash)]
    pub struct Vote {
        /// Search cells along x from the grid's origin.
        pub x: u16,
        /// Search cells along y from the grid's origin.
        pub y: u16,
        /// Index of the heading.
        pub heading: u16,
        /// Sum of the tapers of all beams.
        pub intensity: u16,
    }
}

impl VotesHeader {
    /// Value of `truncated` if the search was cut.
    pub const CUT: u32 = 2;
}

crate::codes! {
    /// Outcome of a search.
    pub enum SearchOutcome: u32 {
        /// The best pose was found, and it has votes.
        Found = 0,
        /// The scan is valid but no beam could vote: no returns, or the map explains no reading.
        NoVotes = 1,
        /// The scan was rejected; the sender's health has the reason.
        Refused = 2,
        /// The scan is kept, and searched if `attention` requests it. No hypotheses follow; the
        /// counters of these messages show losses.
        NotAsked = 3,
    }
}
