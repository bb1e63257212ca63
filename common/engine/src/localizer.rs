//! From a scan to the places at which it may have been taken, in one call.
//!
//! ```text
//! scan ─┬─ map 0: VoteSearch: votes ── peaks::Workspace::judge: places ─┐
//!       ├─ map 1: votes ── places ──────────────────────────────────────┼─ merged: one verdict
//!       └─ map 2: votes ── places ──────────────────────────────────────┘
//! ```
//!
//! The graph runs the two halves in two processes, the accumulator and the peak
//! extractor; a [`Localizer`] runs them one after the other, with the same code.
//!
//! Several maps (the floors of a building, or the buildings of a campus) are searched as one: as
//! soon as a good pose is known on one of them, blocks of the others are compared with its votes, so
//! that ten maps cost far less than ten searches. Votes are compared as shares of the highest
//! possible on each map; ties go to the map listed first. All maps are judged by the same beams, up
//! to the diagonal of the largest map: a beam that is too long for a map matches nothing there.

use crate::EngineError;
use crate::beams::BeamConfig;
use crate::fit::{DistanceField, Ends};
use crate::observation::Observation;
use crate::occupancy_map::Map;
use crate::peaks::{self, Found, Judged, Merged, PeakConfig, PeakInput, Places, merge};
use crate::space::Space;
use crate::tracking::Seen;
use crate::vote_search::{self, Outcome, Preparation, Prior, VoteSearch, VoteSearchConfig};

/// Settings of a [`Localizer`].
#[derive(Debug, Clone, PartialEq, Default)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct Settings {
    /// First stage: finds the poses with the most votes.
    pub vote_search: VoteSearchConfig,
    /// Second stage: groups them to places and decides if one is unambiguous.
    pub peaks: PeakConfig,
    /// Knowledge of the heading with which scans come.
    pub prior: Prior,
}

/// Maps prepared for locating scans, shared by any number of threads.
#[derive(Debug, Clone)]
pub struct Localizer {
    /// At least one map.
    maps: Vec<PreparedMap>,
}

/// A map with everything that both stages need.
#[derive(Debug, Clone)]
pub struct PreparedMap {
    vote_search: VoteSearch,
    distance_field: DistanceField,
    /// Space of the map at full resolution; the votes may be counted on a coarser one.
    space: Space,
    peaks: PeakConfig,
}

/// Buffers for locating, kept from scan to scan: once they are large enough, nothing is allocated
/// any more on a single map. They may serve any localizer.
#[derive(Debug, Default)]
pub struct Workspace {
    maps: Vec<OnMap>,
    merged: Merged,
}

#[derive(Debug, Default)]
struct OnMap {
    votes: vote_search::Workspace,
    peaks: peaks::Workspace,
}

/// Result of locating one scan.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Answer<'w> {
    /// Votes and search statistics on the map of the best place; on the first map if there is no
    /// place.
    pub outcome: &'w Outcome,
    /// Places, each with the number of its map, and the verdict.
    pub places: &'w Places,
    /// Beams of the scan as they were compared with that map.
    pub ends: &'w Ends,
}

impl PreparedMap {
    /// Prepares a map, which takes milliseconds to seconds.
    ///
    /// # Errors
    /// If the map has no occupied or no free cell, or a setting is out of range.
    pub fn new(map: Map<'_>, settings: Settings) -> Result<Self, EngineError> {
        let preparation = Preparation::of_map(map, settings.vote_search, settings.prior)?;
        Self::with(preparation.finish()?, map, settings.peaks)
    }

    /// Does the same with a first stage that was already prepared for the map.
    ///
    /// # Errors
    /// See [`PreparedMap::new`].
    pub fn with(
        vote_search: VoteSearch,
        map: Map<'_>,
        peaks: PeakConfig,
    ) -> Result<Self, EngineError> {
        let ((width, height), headings) = (map.sides, vote_search.config().headings);
        Ok(PreparedMap {
            distance_field: DistanceField::new(map.frame, map.sides, map.occupancy, map.rules)?,
            space: Space::new(headings, map.frame.resolution_m, width, height)?,
            vote_search,
            peaks,
        })
    }

    /// Makes beams count up to this length, see [`Space::reaching`].
    fn reaching(self, reach_m: f64) -> Self {
        PreparedMap {
            vote_search: self.vote_search.reaching(reach_m),
            space: self.space.reaching(reach_m),
            ..self
        }
    }

    /// Runs the second stage.
    fn judge<'w>(
        &self,
        (outcome, peaks): (&Outcome, &'w mut peaks::Workspace),
        scan: Observation<'_>,
        (config, has_others): (&PeakConfig, bool),
    ) -> Result<Judged<'w>, EngineError> {
        let input = PeakInput {
            has_others,
            ..PeakInput::of(outcome, self.vote_search.frame())
        };
        let find = |ends: &mut Ends| ends.find(scan, &self.space, self.beams());
        peaks.judge(&input, &self.distance_field, config, find)
    }

    /// Returns the beams of a scan as the second stage compares them with the map.
    ///
    /// # Errors
    /// If the scan is rejected, see [`Observation::check`].
    pub fn ends<'s>(&self, scan: impl Into<Observation<'s>>) -> Result<Ends, EngineError> {
        Ends::new(scan, &self.space, self.beams())
    }

    /// Returns the map with a scan on it, for a tracker.
    pub(crate) fn seen<'a>(&'a self, ends: &'a Ends) -> Seen<'a> {
        Seen {
            distance_field: &self.distance_field,
            ends,
            fit: &self.peaks.fit,
        }
    }

    fn beams(&self) -> &BeamConfig {
        &self.vote_search.config().votes.beams
    }

    /// The first stage.
    pub fn vote_search(&self) -> &VoteSearch {
        &self.vote_search
    }

    /// Distance field of the map, for the second stage.
    pub fn distance_field(&self) -> &DistanceField {
        &self.distance_field
    }

    /// Settings of the second stage.
    pub fn peaks(&self) -> &PeakConfig {
        &self.peaks
    }
}

impl Localizer {
    /// Prepares a map, which takes milliseconds to seconds.
    ///
    /// # Errors
    /// If the map has no occupied or no free cell, or a setting is out of range.
    pub fn new(map: Map<'_>, settings: Settings) -> Result<Self, EngineError> {
        Self::of_maps(vec![PreparedMap::new(map, settings)?])
    }

    /// Takes one or several maps that are searched together, all prepared with the same settings.
    ///
    /// # Errors
    /// If there is no map.
    pub fn of_maps(maps: Vec<PreparedMap>) -> Result<Self, EngineError> {
        let reach_m = maps.iter().map(|map| map.space.longest_m);
        let reach_m = reach_m.reduce(f64::max).ok_or(EngineError::NoMap)?;
        let maps = maps.into_iter().map(|map| map.reaching(reach_m)).collect();
        Ok(Localizer { maps })
    }

    /// Maps, in the order that decides ties.
    pub fn maps(&self) -> &[PreparedMap] {
        &self.maps
    }

    /// Returns the places at which a scan may have been taken, at any heading.
    ///
    /// # Errors
    /// If the scan is rejected, see [`Observation::check`], or the localizer was prepared for known
    /// headings.
    pub fn locate<'w, 's>(
        &self,
        workspace: &'w mut Workspace,
        scan: impl Into<Observation<'s>>,
    ) -> Result<Answer<'w>, EngineError> {
        let found = self.locate_unless(workspace, scan, None, &|| false)?;
        Ok(found.expect("a search that nothing stops ends with an outcome"))
    }

    /// Locates a scan as [`Localizer::locate`] does, or, if a heading in the maps' frame is given
    /// (radians), among all positions at that heading. Returns `None` if `stop` returned true
    /// before the end.
    ///
    /// # Errors
    /// If the scan is rejected, see [`Observation::check`], if the heading is not finite, or if one
    /// is given and the localizer was prepared for unknown headings, or the other way round.
    pub fn locate_unless<'w, 's>(
        &self,
        workspace: &'w mut Workspace,
        scan: impl Into<Observation<'s>>,
        heading: Option<f64>,
        stop: &dyn Fn() -> bool,
    ) -> Result<Option<Answer<'w>>, EngineError> {
        let (scan, Workspace { maps, merged }) = (scan.into(), workspace);
        maps.resize_with(self.maps.len(), OnMap::default);
        if let [map] = &self.maps[..] {
            let OnMap { votes, peaks } = &mut maps[0];
            let found = map.vote_search.search_in(votes, scan, heading, stop)?;
            let Some(outcome) = found else {
                return Ok(None);
            };
            let judged = map.judge((outcome, peaks), scan, (&map.peaks, false))?;
            return Ok(Some(Answer {
                outcome,
                places: judged.places,
                ends: judged.ends,
            }));
        }
        let searches = self.maps.iter().map(PreparedMap::vote_search);
        let searches = searches.zip(maps.iter_mut().map(|on_map| &mut on_map.votes));
        let found = VoteSearch::search_together(searches.collect(), scan, heading, stop)?;
        found
            .map(|_| self.judge_all(maps, scan, merged))
            .transpose()
    }

    /// Runs the second stage on each map, and merges the places.
    fn judge_all<'w>(
        &self,
        maps: &'w mut [OnMap],
        scan: Observation<'_>,
        merged: &'w mut Merged,
    ) -> Result<Answer<'w>, EngineError> {
        let config = &self.maps[0].peaks;
        let of_each = config.of_each_map();
        let mut found = Vec::with_capacity(maps.len());
        for (number, (map, on_map)) in (0..).zip(self.maps.iter().zip(maps.iter_mut())) {
            let outcome = on_map.votes.outcome();
            let judged = map.judge(
                (outcome, &mut on_map.peaks),
                scan,
                (&of_each, self.maps.len() > 1),
            )?;
            found.push(Found::on(number, outcome.best_share(), &judged));
        }
        *merged = merge(&found, config);
        let best = &maps[merged.best_of];
        merged.places.classes.clone_from(best.peaks.classes());
        Ok(Answer {
            outcome: best.votes.outcome(),
            places: &merged.places,
            ends: best.peaks.ends(),
        })
    }
}

#[cfg(test)]
mod tests;
