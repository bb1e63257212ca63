//! A set of maps searched as one: the floors of a building, or the buildings of a campus.
//!
//! ```text
//! scan ─┬─ map 0: votes ─ places ─┐
//!       ├─ map 1: votes ─ places ─┼─ merged: places that name their map, one verdict
//!       └─ map 2: votes ─ places ─┘
//! ```
//!
//! One search runs over all maps: as soon as a good pose is known on one of them, blocks of the
//! others are compared with its votes, so that ten maps cost far less than ten searches. Votes are
//! compared as shares of the highest possible on each map; ties go to the map listed first. All
//! maps are judged by the same beams, up to the diagonal of the largest map: a beam that is too
//! long for a map matches nothing there.

use crate::EngineError;
use crate::fit::Ends;
use crate::localizer::{Localizer, Outcome};
use crate::locator::{self, Locator};
use crate::observation::Observation;
use crate::peaks::{Found, Merged, Places, merge};

/// Maps prepared for locating scans, shared by any number of threads.
#[derive(Debug, Clone)]
pub struct MapSet {
    locators: Vec<Locator>,
}

/// Buffers for locating, kept from scan to scan. They may serve any set.
#[derive(Debug, Default)]
pub struct Workspace {
    maps: Vec<locator::Workspace>,
    merged: Merged,
}

/// Result of locating one scan on several maps.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Located<'w> {
    /// Votes on the map of the best place; on the first map if there is no place.
    pub outcome: &'w Outcome,
    /// Places, each with the number of its map, and the verdict.
    pub places: &'w Places,
    /// Places in the form that is merged with results of other processes on other maps.
    pub found: &'w Found,
    /// Beams of the scan as they were compared with that map.
    pub ends: &'w Ends,
}

impl Workspace {
    /// Returns the workspace of a single map, for locating on that map alone.
    #[must_use]
    pub fn of_one(&mut self) -> &mut locator::Workspace {
        self.maps.resize_with(1, locator::Workspace::default);
        &mut self.maps[0]
    }
}

impl MapSet {
    /// Makes a set of at least one map, all prepared with the same settings.
    ///
    /// # Panics
    /// If there is no map.
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

    /// Maps, in the order that decides ties.
    #[must_use]
    pub fn locators(&self) -> &[Locator] {
        &self.locators
    }

    /// Returns the places at which a scan may have been taken, on any of the maps; if a heading in
    /// the maps' frames is given (radians), among all positions at that heading. `None` if `stop`
    /// returned true before the end. With one map, the places are those of
    /// [`Locator::locate_unless`].
    ///
    /// # Errors
    /// If the scan is rejected, see [`Observation::check`], or the heading is not finite.
    ///
    /// # Panics
    /// If the locators were prepared for unknown headings and one is given, or vice versa.
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
                Found::on(map, outcome.best_share(), judged)
            })?);
        }
        *merged = merge(&found, config);
        let best = &maps[merged.best_of];
        merged.places.classes.clone_from(best.classes());
        Ok(Some(Located {
            outcome: best.outcome(),
            places: &merged.places,
            found: &merged.found,
            ends: best.ends(),
        }))
    }

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
