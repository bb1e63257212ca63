use geometry::Pose;
use messages::Verdict;
use proptest::prelude::*;

use super::*;
use crate::fit::GridPose;
use crate::grid::{CellRules, Grid, GridFrame};
use crate::localizer::{LocalizerConfig, Prior};
use crate::locator::{LocatorConfig, OccupancyView};
use crate::peaks::PeakConfig;
use crate::program::VoteConfig;
use crate::scan::Scan;
use crate::testing::{any_grid, any_scan, occupancy_of};

/// Prepares a locator; `None` if the grid has no obstacle or no free cell.
fn locator(grid: &Grid, resolution_m: f64, votes: VoteConfig) -> Option<Locator> {
    let occupancy = occupancy_of(grid);
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
        peaks: PeakConfig::default(),
    };
    Locator::new(map, config, Prior::None).ok()
}

proptest! {
    #[test]
    fn a_set_of_one_map_answers_as_that_map_does(
        grid in any_grid(), scan in any_scan(),
    ) {
        let Some(locator) = locator(&grid, 0.1, scan.config()) else { return Ok(()) };
        let mut alone = locator::Workspace::default();
        let found = locator.locate(&mut alone, &scan.scan()).unwrap();
        let set = MapSet::new(vec![locator.clone()]);
        let mut together = Workspace::default();
        let all = set.locate_unless(&mut together, &scan.scan(), None, &|| false).unwrap().unwrap();
        prop_assert_eq!(all.outcome, found.outcome);
        prop_assert_eq!(all.places, found.places);
        prop_assert_eq!(all.ends, found.ends);
    }

    #[test]
    fn alternatives_are_counted_by_scores_and_not_by_bounds(
        grid in any_grid(), scan in any_scan(),
    ) {
        let Some(locator) = locator(&grid, 0.1, scan.config()) else { return Ok(()) };
        let set = MapSet::new(vec![locator.clone(); 2]);
        let mut workspace = Workspace::default();
        let found = set.locate_unless(&mut workspace, &scan.scan(), None, &|| false);
        let found = found.unwrap().unwrap();
        let (ends, config) = (found.ends, locator.peaks());
        let mut scored = found.found.clone();
        for place in &mut scored.places {
            let pose = GridPose::of(locator.distance_field().frame, place.map_from_laser);
            let score = locator.distance_field().score(ends, pose, &config.fit);
            // A pose converted to the map and back differs in its last digits.
            if place.score - score > 1e-9 {
                place.score = score;
            }
        }
        let expected = merge(&[scored], config).places.alternatives;
        prop_assert_eq!(found.places.alternatives, expected);
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
    let locator = locator(&grid, 0.1, VoteConfig::default()).unwrap();
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
