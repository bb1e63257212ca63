use geometry::Pose;
use messages::Verdict;
use proptest::prelude::*;

use super::*;
use crate::fit::GridPose;
use crate::grid::{CellRules, Grid, GridFrame};
use crate::program::VoteConfig;
use crate::testing::{any_grid, any_scan, occupancy_of, scan_from};

/// Prepares a map; `None` if the grid has no obstacle or no free cell.
fn prepared(grid: &Grid, resolution_m: f64, votes: VoteConfig) -> Option<PreparedMap> {
    let occupancy = occupancy_of(grid);
    let map = Map {
        frame: GridFrame::new(resolution_m, Pose::new(1.0, -2.0, 0.3)),
        sides: (grid.width(), grid.height()),
        occupancy: &occupancy,
        rules: CellRules::default(),
    };
    let settings = Settings {
        vote_search: VoteSearchConfig {
            headings: 48,
            votes,
            ..VoteSearchConfig::default()
        },
        ..Settings::default()
    };
    PreparedMap::new(map, settings).ok()
}

proptest! {
    #[test]
    fn a_set_of_one_map_answers_as_that_map_does(
        grid in any_grid(), scan in any_scan(),
    ) {
        let Some(map) = prepared(&grid, 0.1, scan.config()) else { return Ok(()) };
        let localizer = Localizer::of_maps(vec![map]).unwrap();
        let mut alone = Workspace::default();
        let found = localizer.locate(&mut alone, &scan.scan()).unwrap();
        let (scan, mut on_maps) = (scan.scan(), [OnMap::default()]);
        let votes = vec![(localizer.maps[0].vote_search(), &mut on_maps[0].votes)];
        VoteSearch::search_together(votes, (&scan).into(), None, &|| false).unwrap().unwrap();
        let mut merged = Merged::default();
        let all = localizer.judge_all(&mut on_maps, (&scan).into(), &mut merged).unwrap();
        prop_assert_eq!(all, found);
    }

    #[test]
    fn alternatives_are_counted_by_scores_and_not_by_bounds(
        grid in any_grid(), scan in any_scan(),
    ) {
        let Some(map) = prepared(&grid, 0.1, scan.config()) else { return Ok(()) };
        let localizer = Localizer::of_maps(vec![map.clone(); 2]).unwrap();
        let mut workspace = Workspace::default();
        let found = localizer.locate(&mut workspace, &scan.scan()).unwrap();
        let alternatives = found.places.alternatives;
        let (scan, of_each) = (scan.scan(), map.peaks.of_each_map());
        let scored = (0..).zip(&mut workspace.maps).map(|(number, on_map)| {
            let outcome = on_map.votes.outcome();
            let stage = (outcome, &mut on_map.peaks);
            let judged = map.judge(stage, (&scan).into(), (&of_each, true)).unwrap();
            let mut found = Found::on(number, outcome.best_share(), &judged);
            for place in &mut found.places {
                let pose = GridPose::of(map.distance_field.frame, place.map_from_laser);
                let score = map.distance_field.score(judged.ends, pose, &map.peaks.fit);
                // A pose converted to the map and back differs in its last digits.
                if place.score - score > 1e-9 {
                    place.score = score;
                }
            }
            found
        });
        let scored: Vec<Found> = scored.collect();
        prop_assert_eq!(alternatives, merge(&scored, &map.peaks).places.alternatives);
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
    let scan = scan_from(0.0, 10f64.to_radians(), &ranges);
    let map = prepared(&grid, 0.1, VoteConfig::default()).unwrap();
    let mut workspace = Workspace::default();
    let mut ask = |count| {
        let localizer = Localizer::of_maps(vec![map.clone(); count]).unwrap();
        localizer
            .locate(&mut workspace, &scan)
            .unwrap()
            .places
            .clone()
    };
    let (one, two) = (ask(1), ask(2));
    let pose = |places: &Places| (places.places[0].map, places.places[0].map_from_laser);
    assert_eq!(pose(&two), pose(&one), "ties go to the first map");
    assert_eq!(two.places[1].map, 1);
    assert!(two.alternatives > 2 * one.alternatives);
    assert_ne!(two.verdict, Verdict::Unique);
}

#[test]
fn a_heading_that_does_not_go_with_the_preparation_is_an_error() {
    let grid = crate::grid::drawn::grid(&["####", "#..#", "####"]);
    let map = prepared(&grid, 0.1, VoteConfig::default()).unwrap();
    let unknown = Localizer::of_maps(vec![map]).unwrap();
    let occupancy = occupancy_of(&grid);
    let map = Map::new(0.1, Pose::IDENTITY, (4, 3), &occupancy);
    let prior = Prior::Heading;
    let settings = Settings {
        prior,
        ..Settings::default()
    };
    let known = Localizer::new(map, settings).unwrap();
    let scan = scan_from(0.0, 0.1, &[0.1; 12]);
    let mut workspace = Workspace::default();
    let mut ask = |localizer: &Localizer, heading| {
        let answer = localizer.locate_unless(&mut workspace, &scan, heading, &|| false);
        answer.map(|answer| answer.is_some())
    };
    assert_eq!(
        ask(&unknown, Some(1.0)),
        Err(EngineError::HeadingGiven(1.0))
    );
    assert_eq!(ask(&known, None), Err(EngineError::HeadingMissing));
    assert_eq!(
        (ask(&unknown, None), ask(&known, Some(1.0))),
        (Ok(true), Ok(true))
    );
    assert_eq!(
        Localizer::of_maps(Vec::new()).unwrap_err(),
        EngineError::NoMap
    );
}
