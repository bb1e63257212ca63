use geometry::Pose;
use messages::Verdict;
use proptest::collection::vec;
use proptest::prelude::*;

use super::*;
use crate::fit::GridPose;
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
        let locators = locators(&worlds, scan.config());
        prop_assume!(locators.len() > 1);
        let cut = cut.min(locators.len() - 1);
        let mut workspace = Workspace::default();
        let reach_m = locators.iter().map(Locator::longest_m).fold(0.0, f64::max);
        let mut ask = |locators: &[Locator]| {
            let set = MapSet::part(locators.to_vec(), reach_m);
            // As shards do, so that a single map is one of several, too.
            let lead = Lead::default();
            let together = Together { lead: Some(&lead), ..Together::default() };
            let found = set.locate_beside(&mut workspace, &scan.scan(), together, &|| false);
            let found = found.unwrap().unwrap();
            (found.places.clone(), found.found.clone())
        };
        let (whole, all) = ask(&locators);
        let (_, first) = ask(&locators[..cut]);
        let (_, second) = ask(&locators[cut..]);
        let config = *locators[0].peaks();
        let parts = [first, numbered_from(cut, second)];
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

/// The locators of those worlds that have obstacles and room.
fn locators(worlds: &[(Grid, f64)], votes: VoteConfig) -> Vec<Locator> {
    let located = |(grid, side): &(Grid, f64)| locator(grid, *side, votes, Score::Fit);
    worlds.iter().filter_map(located).collect()
}

/// What was found on the maps from this number of a set on.
fn numbered_from(first: usize, mut found: Found) -> Found {
    found.leading_map += first as u32;
    found
        .places
        .iter_mut()
        .for_each(|place| place.map += first as u32);
    found
}

proptest! {
    #[test]
    fn beside_a_pose_elsewhere_a_part_finds_what_counts_beside_it(
        worlds in vec((any_grid(), 0.07..0.14f64), 2..5), scan in any_scan(), cut in 1usize..4,
        told_at in 0u32..40,
    ) {
        let locators = locators(&worlds, scan.config());
        prop_assume!(locators.len() > 1);
        let cut = cut.min(locators.len() - 1);
        let mut workspace = Workspace::default();
        let reach_m = locators.iter().map(Locator::longest_m).fold(0.0, f64::max);
        let mut ask = |locators: &[Locator], lead: &Lead, stop: &dyn Fn() -> bool| {
            let set = MapSet::part(locators.to_vec(), reach_m);
            let together = Together { lead: Some(lead), ..Together::default() };
            let found = set.locate_beside(&mut workspace, &scan.scan(), together, stop);
            found.unwrap().unwrap().found.clone()
        };
        let lead = Lead::default();
        let all = ask(&locators, &lead, &|| false);
        prop_assert_eq!(lead.share().compare(all.lead), std::cmp::Ordering::Equal);
        // It is told before a search, or while one is at work.
        let late = Lead::default();
        let looks = std::cell::Cell::new(0);
        let tell = || {
            looks.set(looks.get() + 1);
            if looks.get() == told_at {
                late.raise(all.lead);
            }
            false
        };
        let config = *locators[0].peaks();
        for (lead, stop) in [(&lead, &(|| false) as &dyn Fn() -> bool), (&late, &tell)] {
            let first = ask(&locators[..cut], lead, stop);
            let second = numbered_from(cut, ask(&locators[cut..], lead, stop));
            let merged = merge(&[first, second], &config).found;
            let on_it = |places: &[Place]| {
                let on_it = places.iter().filter(|place| place.map == all.leading_map);
                on_it.map(|place| (place.map_from_laser, place.score)).collect::<Vec<_>>()
            };
            prop_assert_eq!((merged.lead, merged.leading_map), (all.lead, all.leading_map));
            prop_assert_eq!(on_it(&merged.places), on_it(&all.places));
            let is_certain = |place: &&Place| {
                let collect = locators[place.map as usize].localizer().config().collect;
                place.intensity >= collect.floor(all.lead.on(place.possible))
            };
            for place in all.places.iter().filter(is_certain) {
                // A candidate that only one of both has may stand for it, if it is the same place.
                let apart = (2.0 * config.same_place_m, 2.0 * config.same_place_deg.to_radians());
                let is_it = |other: &Place| other.map == place.map
                    && other.map_from_laser.is_within(place.map_from_laser, apart.0, apart.1);
                prop_assert!(merged.places.iter().any(is_it), "{place:?} of {merged:?}");
            }
        }
    }

    #[test]
    fn alternatives_are_counted_by_scores_and_not_by_bounds(
        grid in any_grid(), scan in any_scan(),
    ) {
        let Some(locator) = locator(&grid, 0.1, scan.config(), Score::Fit) else { return Ok(()) };
        let set = MapSet::new(vec![locator.clone(); 2]);
        let mut workspace = Workspace::default();
        let found = set.locate_unless(&mut workspace, &scan.scan(), None, &|| false);
        let found = found.unwrap().unwrap();
        let (ends, config) = (found.ends.unwrap(), locator.peaks());
        let mut scored = found.found.clone();
        for place in &mut scored.places {
            let pose = GridPose::of(locator.distance_field().frame, place.map_from_laser);
            let score = locator.distance_field().score(ends, pose, &config.fit);
            // A pose that was carried to the map and back differs in its last digits.
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
