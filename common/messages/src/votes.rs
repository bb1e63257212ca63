//! The outcome of one search: the poses that the scan votes for.

use bytemuck::{Pod, Zeroable};
use serde::{Deserialize, Serialize};

#[cfg(feature = "iceoryx2")]
use crate::zero_copy::ZeroCopySend;
use crate::{Pose2, Stamp};

/// Header of topic `votes`; the items are poses by falling intensity, equal ones
/// by (heading, y, x): all at or above `certified_floor`, and distinct candidates
/// below. Where several maps were searched, they are those of each in turn.
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable, Serialize, Deserialize)]
#[cfg_attr(
    feature = "iceoryx2",
    derive(ZeroCopySend),
    type_name("VotesHeader/v6")
)]
#[repr(C)]
pub struct VotesHeader {
    /// Of the scan.
    pub stamp: Stamp,
    /// The map that was searched; 0 where there was none.
    pub map_id: u64,
    /// How many items there are.
    pub total: u64,
    /// Nanoseconds of computing, from scan to votes.
    pub engine_ns: u64,
    /// Poses whose intensity was computed one by one.
    pub poses_evaluated: u64,
    /// A [`SearchOutcome`].
    pub outcome: u32,
    /// Headings a turn; heading `h` is `2π h / headings` in the grid's frame.
    pub headings: u32,
    /// The least intensity among the items; 0 where there are none.
    pub floor: u32,
    /// At and above this intensity the items are all that there are.
    pub certified_floor: u32,
    /// The highest intensity of any pose.
    pub best: u32,
    /// What a pose would have if every beam agreed fully.
    pub highest_possible: u32,
    /// 1 where the floor was raised so that the items fit; [`VotesHeader::CUT`] where the
    /// search took more work than it may, so that poses below the certified floor may have
    /// been missed, which can lie above the best; else 0.
    pub truncated: u32,
    /// Beams that voted.
    pub beams_used: u32,
    /// 1 where the heading was given and only x and y were searched, else 0.
    pub heading_known: u32,
    /// Beams whose reading says nothing: no return, too near or too far.
    pub beams_silent: u32,
    /// The given heading in the map frame, radians; 0 where it was searched.
    pub known_heading: f64,
    /// The largest rounding of a bearing to the heading grid, radians.
    pub bearing_rounding: f64,
    /// Where the laser sits on the robot; identity unless `mount_known`.
    pub base_from_laser: Pose2,
    /// 1 where the mount was given, else 0.
    pub mount_known: u64,
    /// Most beams of a scan that vote; longer scans are thinned by arc.
    pub max_beams: u32,
    /// Cells of the map along the side of a cell that was searched: of this many
    /// are the items' cells.
    pub pooling: u32,
    /// Arc at the reading from which a beam counts fully, metres.
    pub beam_arc_m: f64,
    /// 1 where topic `readings` holds what the second stage is to judge: the scan
    /// was joined from several lasers, or its motion was taken out. Else 0.
    pub has_readings: u32,
    /// Lasers of which the scan was joined.
    pub lasers_used: u32,
    /// Maps that were searched together; their votes follow each other, in the order of topic
    /// `votes_by_map`, which has what this header says of the leading map for each of them. 0
    /// where one map was searched alone.
    pub maps: u64,
    /// What was searched, as [`searched_id`](crate::searched_id) says it: the map's id, and of
    /// a set one of all its maps; 0 where nothing was.
    pub searched: u64,
}

/// Header of topic `votes_by_map`: which of the votes of a scan are on which map. The items
/// are the headers that the votes of each map would have alone; `total` is how many they are.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Pod, Zeroable, Serialize, Deserialize)]
#[cfg_attr(
    feature = "iceoryx2",
    derive(ZeroCopySend),
    type_name("VotesByMapHeader/v1")
)]
#[repr(C)]
pub struct VotesByMapHeader {
    /// Of the scan.
    pub stamp: Stamp,
}

impl VotesHeader {
    /// What `truncated` is where the search was cut.
    pub const CUT: u32 = 2;
}

/// How a search ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(u32)]
pub enum SearchOutcome {
    /// The best pose was found, and it has votes.
    Found = 0,
    /// The scan is sound but no beam could vote: nothing returned, or the map
    /// explains no reading.
    NoVotes = 1,
    /// The scan was refused; the sender's health says why.
    Refused = 2,
    /// The scan is kept, and searched once `attention` asks for it. No hypotheses
    /// follow; the counters of these messages show what was lost.
    NotAsked = 3,
}

impl SearchOutcome {
    /// The outcome with this number, if there is one.
    #[must_use]
    pub fn from_code(code: u32) -> Option<Self> {
        [Self::Found, Self::NoVotes, Self::Refused, Self::NotAsked]
            .into_iter()
            .find(|o| *o as u32 == code)
    }
}

/// A pose of the search grid and its intensity.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Pod, Zeroable, Serialize, Deserialize)]
#[cfg_attr(feature = "iceoryx2", derive(ZeroCopySend), type_name("Vote/v1"))]
#[repr(C)]
pub struct Vote {
    /// Cells that were searched along x from the grid's origin.
    pub x: u16,
    /// Cells that were searched along y from the grid's origin.
    pub y: u16,
    /// Index of the heading.
    pub heading: u16,
    /// Sum of the tapers of all beams.
    pub intensity: u16,
}

#[cfg(test)]
mod tests {
    use super::*;
    crate::pin_layout!(VotesHeader, size 184, align 8, {
        stamp: 0, map_id: 24, total: 32, engine_ns: 40, poses_evaluated: 48, outcome: 56,
        headings: 60, floor: 64, certified_floor: 68, best: 72, highest_possible: 76,
        truncated: 80, beams_used: 84, heading_known: 88, beams_silent: 92, known_heading: 96,
        bearing_rounding: 104, base_from_laser: 112, mount_known: 136,
        max_beams: 144, pooling: 148, beam_arc_m: 152, has_readings: 160,
        lasers_used: 164, maps: 168, searched: 176,
    });

    mod by_map {
        use super::*;
        crate::pin_layout!(VotesByMapHeader, size 24, align 8, { stamp: 0 });
    }

    mod vote {
        use super::*;
        crate::pin_layout!(Vote, size 8, align 2, { x: 0, y: 2, heading: 4, intensity: 6 });
    }

    #[test]
    fn codes_name_their_outcome() {
        assert_eq!(SearchOutcome::from_code(2), Some(SearchOutcome::Refused));
        assert_eq!(SearchOutcome::from_code(3), Some(SearchOutcome::NotAsked));
        assert_eq!(SearchOutcome::from_code(4), None);
    }
}
