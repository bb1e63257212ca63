//! From votes to hypotheses: distinct places, refined, with their spread and a
//! verdict.
//!
//! The votes name candidates, the fit of the scan decides between them:
//!
//! ```text
//! votes ─ summits ─┬─ by_votes ───────────────────────────┬─ places, verdict
//!                  └─ by_fit ─ refined and judged again ──┘
//! ```

mod by_fit;
mod by_votes;
mod config;
mod likelihood;
mod merged;
pub mod sentence;
mod summits;

use geometry::{Covariance, Pose, wrap_angle};
use messages::{Hypothesis, Verdict, Vote};
use nalgebra::Matrix3;

use crate::fit::{BeamClass, DistanceField, Ends};
use crate::grid::GridFrame;
use crate::localizer::Outcome;
pub use by_fit::by_fit;
pub(crate) use by_fit::{doubt_between, lead};
pub use by_votes::by_votes;
pub use config::{PeakConfig, Score};
pub use merged::{Found, Merged, merge};
use sentence::PlaceSummary;
use summits::Summit;

/// The votes of one scan and what is needed to read them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PeakInput<'a> {
    /// By falling intensity.
    pub votes: &'a [Vote],
    /// All poses at or above this intensity are among the votes.
    pub certified_floor: u32,
    /// Whether the search ended before it could prove that no other pose comes near the best.
    pub cut: bool,
    /// What a pose would have if every beam agreed fully.
    pub highest_possible: u32,
    /// The votes of the best pose; where several maps are searched and another one has it,
    /// the least number that is as good here.
    pub lead: u32,
    /// Whether the map is one of several that are searched together.
    pub has_others: bool,
    /// Headings a turn.
    pub headings: u32,
    /// The heading that was given, in the map frame, radians.
    pub known_heading: Option<f64>,
    /// Where the votes' grid lies in the map.
    pub frame: GridFrame,
}

impl<'a> PeakInput<'a> {
    /// The input for an outcome on a map that is searched alone.
    #[must_use]
    pub fn of(outcome: &'a Outcome, frame: GridFrame) -> Self {
        PeakInput {
            votes: &outcome.found.votes,
            certified_floor: u32::from(outcome.found.certified_floor),
            cut: outcome.found.cut,
            highest_possible: outcome.highest_possible,
            lead: outcome.lead.into(),
            has_others: false,
            headings: outcome.headings,
            known_heading: outcome.known_heading,
            frame,
        }
    }

    /// Whether a pose that the search did not come to may have such a share of the best
    /// one's votes.
    fn may_lack(&self, share: f64) -> bool {
        let unseen = self.certified_floor.saturating_sub(1);
        self.cut && f64::from(unseen) >= f64::from(self.lead) * share
    }

    /// The given heading in the grid's frame, radians.
    fn known_heading_in_grid(&self) -> Option<f64> {
        let heading = self.known_heading?;
        Some(wrap_angle(heading - self.frame.map_from_grid.yaw))
    }
}

/// A covariance over cells and radians of a grid's frame, in metres along the
/// map's axes.
pub(crate) fn in_map(frame: GridFrame, in_cells: Matrix3<f64>) -> Covariance {
    let turn = frame.metres_from_cells();
    Covariance(turn * in_cells * turn.transpose())
}

/// One place where the robot may be.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Place {
    /// Number of the map among those that are searched together, from 0.
    pub map: u32,
    /// Pose of the target frame: the laser or, where several are joined,
    /// the base.
    pub map_from_laser: Pose,
    /// The peak's spread, in the map frame.
    pub covariance: Covariance,
    /// How well the scan fits the map there, at most 1; of a place too far behind the best
    /// one to matter, a bound of that by where the beams end. By votes alone, the share of
    /// those that the pose could have at most.
    pub score: f64,
    /// How likely the robot is there, 0..=1; 0 by votes alone.
    pub probability: f64,
    /// Votes of the best pose that led there.
    pub intensity: u16,
    /// Votes that a pose of the map can have at most.
    pub possible: u16,
    /// By how much scores on the map may be off because it was drawn, 0..=1; 0 where it was
    /// measured.
    pub drawn_doubt: f64,
    /// Votes that led there.
    pub support: u64,
}

/// What a scan's votes say.
#[derive(Debug, Clone, PartialEq)]
pub struct Places {
    /// Distinct places, best first.
    pub places: Vec<Place>,
    /// What they allow to say about the pose.
    pub verdict: Verdict,
    /// Other places that fit about as well as the best.
    pub alternatives: u32,
    /// The probability of the best place, 0..=1. By votes alone, how far it
    /// stands above the next, as a share of its votes; where none was
    /// collected, above the floor below which none was searched.
    pub confidence: f64,
    /// Share of the beams by weight that end at an obstacle at the best place;
    /// by votes alone, its score.
    pub inlier_share: f64,
    /// What became of each beam at the best place, in the order of their
    /// bearings; empty by votes alone.
    pub classes: Vec<BeamClass>,
}

impl Place {
    /// As a message says it.
    #[must_use]
    pub fn hypothesis(&self, map_id: u64, target: Target) -> Hypothesis {
        let laser = self.of_laser(target);
        Hypothesis {
            map_id,
            map_from_laser: laser.map_from_laser.into(),
            map_from_base: target.base(self.map_from_laser).into(),
            covariance: laser.covariance.to_rows(),
            score: self.score as f32,
            probability: self.probability as f32,
            intensity: self.intensity.into(),
            support: self.support,
        }
    }
}

/// Whose poses were searched, and how it lies to the first laser and to the base.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Target {
    target_from_laser: Pose,
    target_from_base: Pose,
}

impl Target {
    /// The laser, which may have a known place on the base, or the base of several
    /// lasers, of which the first has one.
    #[must_use]
    pub fn of(base_from_laser: Option<Pose>, is_base: bool) -> Self {
        let base_from_laser = base_from_laser.unwrap_or(Pose::IDENTITY);
        match is_base {
            true => Target {
                target_from_laser: base_from_laser,
                target_from_base: Pose::IDENTITY,
            },
            false => Target {
                target_from_laser: Pose::IDENTITY,
                target_from_base: base_from_laser.inverse(),
            },
        }
    }

    /// The first laser's pose where the target frame has this one.
    #[must_use]
    pub fn laser(self, map_from_target: Pose) -> Pose {
        match self.target_from_laser == Pose::IDENTITY {
            true => map_from_target,
            false => map_from_target.then(self.target_from_laser),
        }
    }

    /// The target frame's pose where the first laser has this one.
    #[must_use]
    pub fn from_laser(self, map_from_laser: Pose) -> Pose {
        match self.target_from_laser == Pose::IDENTITY {
            true => map_from_laser,
            false => map_from_laser.then(self.target_from_laser.inverse()),
        }
    }

    /// The target frame's pose where the base has this one.
    #[must_use]
    pub fn from_base(self, map_from_base: Pose) -> Pose {
        map_from_base.then(self.target_from_base.inverse())
    }

    /// The base's pose where the target frame has this one.
    #[must_use]
    pub fn base(self, map_from_target: Pose) -> Pose {
        map_from_target.then(self.target_from_base)
    }
}

impl Place {
    /// The place of the first laser where this is one of the target frame.
    #[must_use]
    pub fn of_laser(&self, target: Target) -> Place {
        let map_from_laser = target.laser(self.map_from_laser);
        Place {
            map_from_laser,
            covariance: self.covariance.carried(self.map_from_laser, map_from_laser),
            ..*self
        }
    }
}

impl Places {
    /// The verdict in words.
    #[must_use]
    pub fn sentence(&self) -> String {
        let reported = self.places.iter().take(1 + self.alternatives as usize);
        let summaries: Vec<PlaceSummary> = reported
            .map(|place| PlaceSummary {
                map: place.map.into(),
                map_from_laser: place.map_from_laser,
                covariance: place.covariance,
                score: place.score,
            })
            .collect();
        sentence::sentence(self.verdict, &summaries)
    }

    /// Becomes what there is to say of a scan of which nothing voted.
    fn clear(&mut self) {
        self.places.clear();
        self.verdict = Verdict::NoScan;
        self.alternatives = 0;
        self.confidence = 0.0;
        self.inlier_share = 0.0;
        self.classes.clear();
    }
}

impl Default for Places {
    /// A scan of which nothing voted.
    fn default() -> Self {
        Places {
            places: Vec::new(),
            verdict: Verdict::NoScan,
            alternatives: 0,
            confidence: 0.0,
            inlier_share: 0.0,
            classes: Vec::new(),
        }
    }
}

/// By how much the best place must lead over others to stand alone.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Margin {
    /// For what its scan says, see [`PeakConfig::least_lead`].
    pub needed: f64,
    /// A lead that may come from what the map leaves out.
    pub left_out: f64,
    /// Whether a pose that the search did not come to may be as good.
    pub may_lack: bool,
}

/// What reading places takes, and the last ones. Kept from scan to scan: once
/// the buffers are large enough, nothing is allocated any more. It may serve any map.
#[derive(Debug, Default)]
pub struct Workspace {
    summits: Vec<Summit>,
    /// Places as they come to be refined, with their ranks by votes.
    refined: Vec<(usize, Place)>,
    /// Of the best place over each.
    leads: Vec<f64>,
    places: Places,
    /// What the best of them needs to stand alone.
    margin: Margin,
    /// The beams of the last scan that was compared with a map.
    ends: Ends,
}

/// What votes and the scan say about the pose.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Judged<'w> {
    /// Distinct places, and the verdict.
    pub places: &'w Places,
    /// The beams that were compared with the map; none where the votes alone decide.
    pub ends: Option<&'w Ends>,
    /// By how much the best place must lead over others.
    pub margin: Margin,
}

impl Workspace {
    /// What became of each beam of the last scan at its best place.
    #[must_use]
    pub fn classes(&self) -> &Vec<BeamClass> {
        &self.places.classes
    }

    /// The beams of the last scan, where places are judged by them.
    #[must_use]
    pub fn judged_ends(&self, score: Score) -> Option<&Ends> {
        (score == Score::Fit).then_some(&self.ends)
    }

    /// Reads the places as the settings want it: from the votes alone, or from how well the
    /// scan fits the map, which is then asked for. The map must be that of the votes; its
    /// cells may be finer, with the same origin.
    ///
    /// # Errors
    /// What `scan` says.
    pub fn judge<E>(
        &mut self,
        input: &PeakInput<'_>,
        distance_field: &DistanceField,
        config: &PeakConfig,
        scan: impl FnOnce(&mut Ends) -> Result<(), E>,
    ) -> Result<Judged<'_>, E> {
        if config.score == Score::Votes {
            let places = self.by_votes(input, config);
            return Ok(Judged {
                places,
                ends: None,
                margin: Margin {
                    may_lack: input.may_lack(config.ambiguous_share),
                    ..Margin::default()
                },
            });
        }
        // Out of the workspace while that is at work.
        let mut ends = std::mem::take(&mut self.ends);
        let found = scan(&mut ends).map(|()| {
            self.by_fit(input, (distance_field, &ends), config);
        });
        self.ends = ends;
        found.map(|()| Judged {
            places: &self.places,
            ends: Some(&self.ends),
            margin: self.margin,
        })
    }
}

#[cfg(test)]
mod tests;
