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
use crate::localizer::{Localizer, Outcome, Together};
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
        MapSet::part(locators, 0.0)
    }

    /// A part of a set whose largest map has a diagonal of so many metres, for others search
    /// the rest.
    ///
    /// # Panics
    /// If it has no map.
    #[must_use]
    pub fn part(locators: Vec<Locator>, reach_m: f64) -> Self {
        assert!(!locators.is_empty(), "a set of maps has at least one");
        let longest = locators.iter().map(Locator::longest_m);
        let reach_m = longest.fold(reach_m, f64::max);
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
        let together = Together {
            heading,
            ..Together::default()
        };
        self.locate_beside(workspace, scan, together, stop)
    }

    /// The same while others search other maps: beside what the best pose has, be it theirs, too
    /// few votes are left out, as if one search had found all.
    ///
    /// # Errors
    /// See [`MapSet::locate_unless`].
    ///
    /// # Panics
    /// See [`MapSet::locate_unless`].
    pub fn locate_beside<'w, 's>(
        &self,
        workspace: &'w mut Workspace,
        scan: impl Into<Observation<'s>>,
        together: Together<'_>,
        stop: &dyn Fn() -> bool,
    ) -> Result<Option<Located<'w>>, EngineError> {
        let scan = scan.into();
        if self.search(workspace, scan, together, stop)?.is_none() {
            return Ok(None);
        }
        let Workspace { maps, merged } = workspace;
        let config = self.locators[0].peaks();
        let all = config.of_each_map();
        let mut found = Vec::with_capacity(maps.len());
        for (map, (locator, workspace)) in (0..).zip(self.locators.iter().zip(maps.iter_mut())) {
            found.push(locator.judge(workspace, scan, &all, |outcome, judged| {
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
        together: Together<'_>,
        stop: &dyn Fn() -> bool,
    ) -> Result<Option<usize>, EngineError> {
        let maps = &mut workspace.maps;
        maps.resize_with(self.locators.len(), locator::Workspace::default);
        let localizers = self.locators.iter().map(Locator::localizer);
        let searched = localizers.zip(maps.iter_mut().map(locator::Workspace::localizer));
        Localizer::search_together(searched.collect(), scan, together, stop)
    }
}

#[cfg(test)]
mod tests {
    use geometry::Pose;
    use messages::Verdict;
    use proptest::collection::vec;
    use proptest::prelude::*;

    use super::*;
    use crate::grid::{Cell, CellRules, Grid, GridFrame};
    use crate::localizer::{LocalizerConfig, Prior};
    use crate::locator::{LocatorConfig, OccupancyView};
    use crate::peaks::{PeakConfig, Place, Score};
    use crate::program::VoteConfig;
    use crate::scan::Scan;
    use crate::search::Lead;
    use crate::testing::{any_grid, any_scan};

    /// None where the grid has no obstacle or no room.
    fn locator(grid: &Grid, resolution_m: f64, votes: VoteConfig, score: Score) -> Option<Locator> {
        let occupancy: Vec<u8> = grid
            .cells()
            .iter()
            .map(|cell| match cell {
                Cell::Occupied => 100,
                _ => 0,
            })
            .collect();
        let map = OccupancyView {
            frame: GridFrame {
                resolution_m,
                map_from_grid: Pose::new(1.0, -2.0, 0.3),
            },
            sides: (grid.width(), grid.height()),
            occupancy: &occupancy,
            rules: CellRules::default(),
        };
        let config = LocatorConfig {
            localizer: LocalizerConfig {
                headings: 48,
                votes,
                ..LocalizerConfig::default()
            },
            peaks: PeakConfig {
                score,
                ..PeakConfig::default()
            },
        };
        Locator::new(map, config, Prior::None).ok()
    }

    proptest! {
        #[test]
        fn a_set_of_one_map_answers_as_that_map_does(
            grid in any_grid(), scan in any_scan(), by_votes: bool,
        ) {
            let score = if by_votes { Score::Votes } else { Score::Fit };
            let Some(locator) = locator(&grid, 0.1, scan.config(), score) else { return Ok(()) };
            let mut alone = locator::Workspace::default();
            let found = locator.locate(&mut alone, &scan.scan()).unwrap();
            let set = MapSet::new(vec![locator.clone()]);
            let mut together = Workspace::default();
            let all = set.locate_unless(&mut together, &scan.scan(), None, &|| false).unwrap().unwrap();
            prop_assert_eq!(all.outcome, found.outcome);
            prop_assert_eq!(&all.places.places, &found.places.places);
            prop_assert_eq!(&all.places.classes, &found.places.classes);
            let said = |places: &Places| (places.verdict, places.alternatives, places.inlier_share);
            prop_assert_eq!(said(all.places), said(found.places));
            // By votes alone they are shares here, and votes there.
            prop_assert!((all.places.confidence - found.places.confidence).abs() < 1e-12);
            prop_assert_eq!(all.ends, found.ends);
        }

        #[test]
        fn parts_of_a_set_that_are_merged_have_its_best_pose_by_votes(
            worlds in vec((any_grid(), 0.07..0.14f64), 2..6), scan in any_scan(), cut in 1usize..5,
        ) {
            let locators = worlds.iter().filter_map(|(grid, side)| locator(grid, *side, scan.config(), Score::Fit));
            let locators: Vec<Locator> = locators.collect();
            prop_assume!(locators.len() > 1);
            let cut = cut.min(locators.len() - 1);
            let mut workspace = Workspace::default();
            let reach_m = locators.iter().map(Locator::longest_m).fold(0.0, f64::max);
            let mut ask = |locators: &[Locator]| {
                let set = MapSet::part(locators.to_vec(), reach_m);
                let found = set.locate_unless(&mut workspace, &scan.scan(), None, &|| false);
                let found = found.unwrap().unwrap();
                (found.places.clone(), found.found.clone())
            };
            let (whole, all) = ask(&locators);
            let (_, first) = ask(&locators[..cut]);
            let (_, mut second) = ask(&locators[cut..]);
            let config = *locators[0].peaks();
            second.leading_map += cut as u32;
            second.places.iter_mut().for_each(|place| place.map += cut as u32);
            let parts = [first, second];
            for parts in [&parts[..], &[parts[1].clone(), parts[0].clone()]] {
                let merged = merge(parts, &config);
                prop_assert_eq!(merged.found.lead, all.lead);
                prop_assert_eq!(merged.found.leading_map, all.leading_map);
                prop_assert_eq!(merged.places.places.is_empty(), whole.places.is_empty());
                // Of the map that has it, all that one search finds are among the places.
                let on_it = |places: &[Place]| {
                    let on_it = places.iter().filter(|place| place.map == all.leading_map);
                    on_it.map(|place| (place.map_from_laser, place.score)).collect::<Vec<_>>()
                };
                prop_assert_eq!(on_it(&merged.found.places), on_it(&all.places));
            }
        }
    }

    proptest! {
        #[test]
        fn beside_a_pose_elsewhere_a_part_finds_what_counts_beside_it(
            worlds in vec((any_grid(), 0.07..0.14f64), 2..5), scan in any_scan(), cut in 1usize..4,
        ) {
            let locators = worlds.iter().filter_map(|(grid, side)| locator(grid, *side, scan.config(), Score::Fit));
            let locators: Vec<Locator> = locators.collect();
            prop_assume!(locators.len() > 1);
            let cut = cut.min(locators.len() - 1);
            let mut workspace = Workspace::default();
            let reach_m = locators.iter().map(Locator::longest_m).fold(0.0, f64::max);
            let mut ask = |locators: &[Locator], lead: &Lead| {
                let set = MapSet::part(locators.to_vec(), reach_m);
                let together = Together { lead: Some(lead), ..Together::default() };
                let found = set.locate_beside(&mut workspace, &scan.scan(), together, &|| false);
                found.unwrap().unwrap().found.clone()
            };
            let lead = Lead::default();
            let all = ask(&locators, &lead);
            prop_assert_eq!(lead.share().compare(all.lead), std::cmp::Ordering::Equal);
            let first = ask(&locators[..cut], &lead);
            let mut second = ask(&locators[cut..], &lead);
            let config = *locators[0].peaks();
            second.leading_map += cut as u32;
            second.places.iter_mut().for_each(|place| place.map += cut as u32);
            let merged = merge(&[first, second], &config).found;
            let on_it = |places: &[Place]| {
                let on_it = places.iter().filter(|place| place.map == all.leading_map);
                on_it.map(|place| (place.map_from_laser, place.score)).collect::<Vec<_>>()
            };
            prop_assert_eq!((merged.lead, merged.leading_map), (all.lead, all.leading_map));
            prop_assert_eq!(on_it(&merged.places), on_it(&all.places));
        }
    }

    #[test]
    fn a_place_on_another_map_is_an_alternative() {
        let rows = [
            "##########",
            "#........#",
            "#.....####",
            "#........#",
            "##########",
        ];
        let grid = crate::grid::drawn::grid(&rows);
        let ranges: Vec<f32> = (0..36).map(|_| 0.2).collect();
        let scan = Scan {
            angle_min: 0.0,
            angle_increment: 10f64.to_radians(),
            range_min_m: 0.0,
            range_max_m: 9.0,
            ranges: &ranges,
        };
        let locator = locator(&grid, 0.1, VoteConfig::default(), Score::Fit).unwrap();
        let mut workspace = Workspace::default();
        let mut ask = |count| {
            let set = MapSet::new(vec![locator.clone(); count]);
            let found = set.locate_unless(&mut workspace, &scan, None, &|| false);
            found.unwrap().unwrap().places.clone()
        };
        let (one, two) = (ask(1), ask(2));
        let pose = |places: &Places| (places.places[0].map, places.places[0].map_from_laser);
        assert_eq!(pose(&two), pose(&one), "ties go to the first map");
        assert_eq!(two.places[1].map, 1);
        assert!(two.alternatives > 2 * one.alternatives);
        assert_ne!(two.verdict, Verdict::Unique);
    }
}
