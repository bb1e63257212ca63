//! Where the robot may be.

use bytemuck::{Pod, Zeroable};
use serde::{Deserialize, Serialize};

#[cfg(feature = "iceoryx2")]
use crate::zero_copy::ZeroCopySend;
use crate::{Pose2, Stamp};

/// Header of topic `hypotheses`; the items are distinct poses, best first.
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable, Serialize, Deserialize)]
#[cfg_attr(
    feature = "iceoryx2",
    derive(ZeroCopySend),
    type_name("HypothesesHeader/v4")
)]
#[repr(C)]
pub struct HypothesesHeader {
    /// Of the scan.
    pub stamp: Stamp,
    /// The map that was searched; of several, that of the best place; 0 where there was none.
    pub map_id: u64,
    /// `CLOCK_MONOTONIC` in nanoseconds when the hypotheses were sent.
    pub sent_ns: i64,
    /// Nanoseconds of computing, from scan to votes.
    pub search_ns: u64,
    /// Nanoseconds of computing, from votes to hypotheses.
    pub extract_ns: u64,
    /// A [`Verdict`].
    pub verdict: u32,
    /// Other places that fit about as well as the best; 0 where it is unique.
    pub alternatives: u32,
    /// The probability of the best pose, 0..=1; by votes alone, its lead.
    pub confidence: f32,
    /// Share of the beams' weight that agrees with the best pose, 0..=1.
    pub inlier_share: f32,
    /// The highest intensity of any pose.
    pub best: u32,
    /// What a pose would have if every beam agreed fully.
    pub highest_possible: u32,
    /// 1 where the laser's mount is known and `map_from_base` is meant, else 0.
    pub mount_known: u64,
    /// What was searched, as [`searched_id`](crate::searched_id) says it: the map's id, and of
    /// a set one of all its maps; 0 where nothing was. So an answer that found nothing differs
    /// from none.
    pub searched: u64,
}

impl HypothesesHeader {
    /// Those of the places that are on the best one's map, for who knows one map alone.
    pub fn on_map<'a>(
        &self,
        places: &'a [Hypothesis],
    ) -> impl Iterator<Item = &'a Hypothesis> + Clone + use<'a> {
        let map_id = self.map_id;
        places.iter().filter(move |place| place.map_id == map_id)
    }
}

/// One place where the robot may be.
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable, Serialize, Deserialize)]
#[cfg_attr(feature = "iceoryx2", derive(ZeroCopySend), type_name("Hypothesis/v3"))]
#[repr(C)]
pub struct Hypothesis {
    /// Pose of the laser in the map.
    pub map_from_laser: Pose2,
    /// Pose of the robot's base in the map; the laser's where no mount is known.
    pub map_from_base: Pose2,
    /// Of `map_from_laser`, row by row over x, y and yaw: m², m·rad, rad².
    pub covariance: [f64; 9],
    /// How well the scan fits the map there, at most 1; of a place too far behind the best one to
    /// matter, a bound of that. By votes alone, the share of those that the pose could have at
    /// most.
    pub score: f32,
    /// How likely the robot is there, 0..=1; what the hypotheses leave is that it
    /// is at none of them.
    pub probability: f32,
    /// Votes of the best pose that led there.
    pub intensity: u64,
    /// Votes that led there.
    pub support: u64,
    /// The map that `map_from_laser` is about.
    pub map_id: u64,
}

/// What the scan allows to say about the pose.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(u32)]
pub enum Verdict {
    /// Nothing to go by: the scan was empty, refused, or explains nothing.
    NoScan = 0,
    /// One place fits, and no other comes near it.
    Unique = 1,
    /// Several places fit about as well.
    Ambiguous = 2,
    /// Even the best place fits badly: perhaps not this map.
    PoorFit = 3,
}

impl Verdict {
    /// The verdict with this number, if there is one.
    #[must_use]
    pub fn from_code(code: u32) -> Option<Self> {
        [Self::NoScan, Self::Unique, Self::Ambiguous, Self::PoorFit]
            .into_iter()
            .find(|v| *v as u32 == code)
    }

    /// The word that logs and tables show.
    #[must_use]
    pub fn as_str(self) -> &'static str {
        match self {
            Verdict::NoScan => "NoScan",
            Verdict::Unique => "Unique",
            Verdict::Ambiguous => "Ambiguous",
            Verdict::PoorFit => "PoorFit",
        }
    }
}

impl std::fmt::Display for Verdict {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.pad(self.as_str())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    crate::pin_layout!(HypothesesHeader, size 96, align 8, {
        stamp: 0, map_id: 24, sent_ns: 32, search_ns: 40, extract_ns: 48, verdict: 56,
        alternatives: 60, confidence: 64, inlier_share: 68, best: 72, highest_possible: 76,
        mount_known: 80, searched: 88,
    });

    mod hypothesis {
        use super::*;
        crate::pin_layout!(Hypothesis, size 152, align 8, {
            map_from_laser: 0, map_from_base: 24, covariance: 48, score: 120,
            probability: 124, intensity: 128, support: 136, map_id: 144,
        });
    }
}
