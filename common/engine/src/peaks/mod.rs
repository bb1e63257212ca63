//! From votes to hypotheses: distinct places, refined, with their covariances and a verdict.
//!
//! The votes give candidates, and the fit of the scan decides between them:
//!
//! ```text
//! votes ─ summits ─ refined, scored ─ judge: places, verdict
//! ```

mod config;
mod judge;
mod likelihood;
mod merged;
mod refined;
pub mod sentence;
mod summits;

use geometry::{Covariance, Pose, wrap_angle};
use messages::{Hypothesis, Verdict, Vote};
use nalgebra::Matrix3;

use crate::fit::{BeamClass, DistanceField, Ends};
use crate::grid::GridFrame;
use crate::vote_search::Outcome;
pub use config::PeakConfig;
pub(crate) use judge::doubt_between;
pub(crate) use likelihood::lead;
pub use merged::{Found, Merged, merge};
use sentence::PlaceSummary;
use summits::Summit;

/// Share of the best pose's votes from which a pose that the search did not reach may be as good.
const RIVAL_SHARE: f64 = 0.92;

/// Votes of one scan, and the data needed to interpret them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PeakInput<'a> {
    /// Votes by falling intensity.
    pub votes: &'a [Vote],
    /// All poses at or above this intensity are among the votes.
    pub certified_floor: u32,
    /// True if the search ended before it could prove that no other pose comes near the best.
    pub cut: bool,
    /// Votes of a pose with which every beam agrees fully.
    pub highest_possible: u32,
    /// Votes of the best pose; if another of several maps has it, the smallest number of votes that
    /// is as good on this map.
    pub lead: u32,
    /// True if the map is one of several that are searched together.
    pub has_others: bool,
    /// Number of headings per turn.
    pub headings: u32,
    /// Known heading in the map frame, in radians; `None` if all headings were searched.
    pub known_heading: Option<f64>,
    /// Cell size and pose in the map of the votes' grid.
    pub frame: GridFrame,
}

impl<'a> PeakInput<'a> {
    /// Makes the input from an outcome on a map that is searched alone.
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

    /// True if a pose that the search did not reach may be as good as the best one.
    fn may_lack(&self) -> bool {
        let left = self.certified_floor.saturating_sub(1);
        self.cut && f64::from(left) >= f64::from(self.lead) * RIVAL_SHARE
    }

    /// Known heading in the grid's frame, in radians.
    fn known_heading_in_grid(&self) -> Option<f64> {
        let heading = self.known_heading?;
        Some(wrap_angle(heading - self.frame.map_from_grid.yaw))
    }
}

/// Converts a covariance over cells and radians of a grid's frame to metres along the map's axes.
pub(crate) fn in_map(frame: GridFrame, in_cells: Matrix3<f64>) -> Covariance {
    let turn = frame.metres_from_cells();
    (turn * in_cells * turn.transpose()).into()
}

/// One place where the robot may be.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Place {
    /// Number of the map among those searched together, from 0.
    pub map: u32,
    /// Pose of the target frame: the laser or, if several are joined, the base.
    pub map_from_laser: Pose,
    /// Covariance of the pose, in the map frame.
    pub covariance: Covariance,
    /// Score of the fit there, at most 1; an upper bound for places too far behind the best to
    /// matter.
    pub score: f64,
    /// Probability that the robot is there, 0..=1.
    pub probability: f64,
    /// Votes of the best pose from which the place was refined.
    pub intensity: u16,
    /// Highest possible votes of a pose on the map.
    pub possible: u16,
    /// Error of scores on the map because it was drawn, 0..=1; 0 on a measured map.
    pub drawn_doubt: f64,
    /// Number of votes that belong to the place.
    pub support: u64,
}

/// Places found for a scan, and the verdict; none by default, as for a scan without votes.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Places {
    /// Distinct places, best first.
    pub places: Vec<Place>,
    /// Verdict on the pose.
    pub verdict: Verdict,
    /// Number of other places that fit about as well as the best.
    pub alternatives: u32,
    /// Probability of the best place, 0..=1.
    pub confidence: f64,
    /// Share of the beams, by weight, that end at an obstacle at the best place.
    pub inlier_share: f64,
    /// Class of each beam at the best place, in the order of bearings.
    pub classes: Vec<BeamClass>,
}

impl Place {
    /// Converts the place to a message.
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

    /// Converts a place of the target frame to one of the first laser.
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

/// The target frame, whose poses are searched, with its relation to the first laser and the base.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Target {
    target_from_laser: Pose,
    target_from_base: Pose,
}

impl Target {
    /// Makes the target: a laser, whose mount on the base may be known, or the base of several
    /// lasers, with the mount of the first.
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

    /// Converts a pose of the target frame to that of the first laser.
    #[must_use]
    pub fn laser(self, map_from_target: Pose) -> Pose {
        match self.target_from_laser == Pose::IDENTITY {
            true => map_from_target,
            false => map_from_target.then(self.target_from_laser),
        }
    }

    /// Converts a pose of the first laser to that of the target frame.
    #[must_use]
    pub fn from_laser(self, map_from_laser: Pose) -> Pose {
        match self.target_from_laser == Pose::IDENTITY {
            true => map_from_laser,
            false => map_from_laser.then(self.target_from_laser.inverse()),
        }
    }

    /// Converts a pose of the base to that of the target frame.
    #[must_use]
    pub fn from_base(self, map_from_base: Pose) -> Pose {
        map_from_base.then(self.target_from_base.inverse())
    }

    /// Converts a pose of the target frame to that of the base.
    #[must_use]
    pub fn base(self, map_from_target: Pose) -> Pose {
        map_from_target.then(self.target_from_base)
    }
}

impl Places {
    /// Returns the verdict in words.
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

    /// Resets to the result of a scan without votes.
    fn clear(&mut self) {
        self.places.clear();
        self.verdict = Verdict::NoScan;
        self.alternatives = 0;
        self.confidence = 0.0;
        self.inlier_share = 0.0;
        self.classes.clear();
    }
}

/// Requirements for the best place to be unique.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Margin {
    /// Gap of its score below the sure score, see [`PeakConfig::sure_score`], beyond that due to
    /// things the map leaves out.
    pub doubt: f64,
    /// Part of a lead that does not count because the map leaves things out.
    pub left_out: f64,
    /// Weight of leads, 0..=1: less than 1 for a scan of few beams.
    pub weight: f64,
    /// True if a pose that the search did not reach may be as good.
    pub may_lack: bool,
}

impl Default for Margin {
    /// Margin of a scan that needs no more than any.
    fn default() -> Self {
        Margin {
            doubt: 0.0,
            left_out: 0.0,
            weight: 1.0,
            may_lack: false,
        }
    }
}

/// Buffers for finding places, and the last places. Kept from scan to scan: once the buffers are
/// large enough, nothing is allocated any more. They may serve any map.
#[derive(Debug, Default)]
pub struct Workspace {
    summits: Vec<Summit>,
    /// Places in the order of refinement, with their ranks by votes.
    refined: Vec<(usize, Place)>,
    /// Lead of the best place over each place.
    leads: Vec<f64>,
    places: Places,
    /// Requirements for the best place to be unique.
    margin: Margin,
    /// Beams of the last scan that was compared with a map.
    ends: Ends,
}

/// Places that votes and scan give, with the margin of the verdict.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Judged<'w> {
    /// Distinct places and verdict.
    pub places: &'w Places,
    /// Beams that were compared with the map.
    pub ends: &'w Ends,
    /// Requirements for the best place to be unique.
    pub margin: Margin,
}

impl Workspace {
    /// Class of each beam of the last scan at its best place.
    pub fn classes(&self) -> &Vec<BeamClass> {
        &self.places.classes
    }

    /// Beams of the last scan.
    pub fn ends(&self) -> &Ends {
        &self.ends
    }

    /// Finds the places from the votes of a scan and from its fit to the map. `scan` fills in the
    /// beams. The map must be that of the votes; its cells may be finer, with the same origin.
    ///
    /// # Errors
    /// The error of `scan`.
    pub fn judge<E>(
        &mut self,
        input: &PeakInput<'_>,
        distance_field: &DistanceField,
        config: &PeakConfig,
        scan: impl FnOnce(&mut Ends) -> Result<(), E>,
    ) -> Result<Judged<'_>, E> {
        // The ends are taken out of the workspace while it is borrowed.
        let mut ends = std::mem::take(&mut self.ends);
        let found = scan(&mut ends).map(|()| {
            self.find(input, (distance_field, &ends), config);
        });
        self.ends = ends;
        found.map(|()| Judged {
            places: &self.places,
            ends: &self.ends,
            margin: self.margin,
        })
    }
}

#[cfg(test)]
mod tests;
