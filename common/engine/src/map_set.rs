//! Several maps, searched as one: the floors of a building, or all buildings of a campus.
//!
//! ```text
//! scan ─┬─ map 0: votes ─ places ─┐
//!       ├─ map 1: votes ─ places ─┼─ merged: places that name their map, one verdict
//!       └─ map 2: votes ─ places ─┘
//! ```
//!
//! The search is one over all maps: as soon as a good pose is known on one of them, blocks of
//! the others are compared with its votes, so that ten maps cost far less than ten searches.
//! Votes are compared as shares of what is possible on each map; ties go to the map that is
//! named first. All maps are judged by the same beams, up to the diagonal of the largest: one
//! that is too long for a map fits nothing there.

use crate::EngineError;
use crate::fit::Ends;
use crate::localizer::{Localizer, Outcome};
use crate::locator::{self, Locator};
use crate::observation::Observation;
use crate::peaks::{Found, Merged, Places, merge};

/// Maps that are ready to be asked, by any number of threads.
#[derive(Debug, Clone)]
pub struct MapSet {
    locators: Vec<Locator>,
}

/// What locating takes, kept from scan to scan. It may serve any set.
#[derive(Debug, Default)]
pub struct Workspace {
    maps: Vec<locator::Workspace>,
    merged: Merged,
}

/// What a scan says about map and pose.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Located<'w> {
    /// The votes on the map of the best place; of the first map where there is no place.
    pub outcome: &'w Outcome,
    /// The places, each with the number of its map, and the verdict.
    pub places: &'w Places,
    /// The same as it is merged with what others found on other maps.
    pub found: &'w Found,
    /// The scan's beams as they were compared with that map; none where the votes alone
    /// decide.
    pub ends: Option<&'w Ends>,
}

impl Workspace {
    /// That of one map, for who asks it by itself.
    #[must_use]
    pub fn of_one(&mut self) -> &mut locator::Workspace {
        self.maps.resize_with(1, locator::Workspace::default);
        &mut self.maps[0]
    }
}

impl MapSet {
    /// A set of at least one map, all prepared with the same settings.
    ///
    /// # Panics
    /// If there is none.
    #[must_use]
    pub fn new(locators: Vec<Locator>) -> Self {
        assert!(!locators.is_empty(), "a set of maps has at least one");
        let longest = locators.iter().map(Locator::longest_m);
        let reach_m = longest.fold(0.0, f64::max);
        let locators = locators.into_iter();
        MapSet {
            locators: locators.map(|map| map.reaching(reach_m)).collect(),
        }
    }

    /// The maps, in the order by which ties are decided.
    #[must_use]
    pub fn locators(&self) -> &[Locator] {
        &self.locators
    }

    /// The places at which a scan may have been taken, on any of the maps; among all positions
    /// at a heading in the maps' frames, radians, where one is given; `None` if `stop` said so
    /// before the end. Of one map, the places are those of [`Locator::locate_unless`].
    ///
    /// # Errors
    /// If the scan is refused, see [`Observation::check`], or the heading not finite.
    ///
    /// # Panics
    /// If the locators were prepared for unknown headings and one is given, or the other way
    /// round.
    pub fn locate_unless<'w, 's>(
        &self,
        workspace: &'w mut Workspace,
        scan: impl Into<Observation<'s>>,
        heading: Option<f64>,
        stop: &dyn Fn() -> bool,
    ) -> Result<Option<Located<'w>>, EngineError> {
        let scan = scan.into();
        let has_others = self.locators.len() > 1;
        if self.search(workspace, scan, heading, stop)?.is_none() {
            return Ok(None);
        }
        let Workspace { maps, merged } = workspace;
        let config = self.locators[0].peaks();
        let all = config.of_each_map();
        let mut found = Vec::with_capacity(maps.len());
        for (map, (locator, workspace)) in (0..).zip(self.locators.iter().zip(maps.iter_mut())) {
            let how = (&all, has_others);
            found.push(locator.judge(workspace, scan, how, |outcome, judged| {
                Found::on(map, outcome, judged)
            })?);
        }
        *merged = merge(&found, config);
        let best = &maps[merged.best_of];
        merged.places.classes.clone_from(best.classes());
        Ok(Some(Located {
            outcome: best.outcome(),
            places: &merged.places,
            found: &merged.found,
            ends: best.ends(config.score),
        }))
    }
}

impl MapSet {
    fn search(
        &self,
        workspace: &mut Workspace,
        scan: Observation<'_>,
        heading: Option<f64>,
        stop: &dyn Fn() -> bool,
    ) -> Result<Option<usize>, EngineError> {
        let maps = &mut workspace.maps;
        maps.resize_with(self.locators.len(), locator::Workspace::default);
        let localizers = self.locators.iter().map(Locator::localizer);
        let searched = localizers.zip(maps.iter_mut().map(locator::Workspace::localizer));
        Localizer::search_together(searched.collect(), scan, heading, stop)
    }
}

#[cfg(test)]
mod tests;
