use std::cell::Cell;
use std::f64::consts::FRAC_PI_2;

use geometry::Pose;
use proptest::collection::vec;
use proptest::prelude::*;

use super::*;
use crate::Map;
use crate::boundary;
use crate::fit::{DistanceField, Ends};
use crate::grid::CellRules;
use crate::grid::drawn::grid;
use crate::peaks::{self, PeakConfig, PeakInput};
use crate::testing::{
    AnyScan, RESOLUTION_M, any_grid, any_scan, occupancy_of, ranges_at, scan_around as scan,
};

/// An L-shaped room with a pillar, without symmetry: every pose is distinguishable.
const ROOM: [&str; 12] = [
    "####################",
    "#..................#",
    "#..................#",
    "#...........##.....#",
    "#...........##.....#",
    "#..................#",
    "#.......############",
    "#.......#...........",
    "#.......#...........",
    "#..#....#...........",
    "#.......#...........",
    "#########...........",
];
const FRAME: GridFrame = GridFrame::new(0.25, Pose::new(3.0, -1.0, 0.5));

fn vote_search(prior: Prior) -> VoteSearch {
    let grid = grid(&ROOM);
    VoteSearch::new(FRAME, grid, VoteSearchConfig::default(), prior).unwrap()
}

fn ranges(x: i64, y: i64, heading: usize) -> Vec<f32> {
    ranges_at(&grid(&ROOM), FRAME.resolution_m, (x, y, heading))
}

#[test]
fn a_known_heading_is_taken_in_the_map_frame() {
    let ranges = ranges(5, 3, 40);
    let heading = 40f64.to_radians() + 0.5;
    let (outcome, field) = vote_search(Prior::Heading)
        .search_at(&scan(&ranges), heading, &|| false)
        .unwrap()
        .unwrap();
    let best = outcome.found.votes[0];
    assert_eq!((best.x, best.y, best.heading), (5, 3, 40));
    assert_eq!(field[3 * 20 + 5], best.intensity);
    assert!(outcome.bearing_rounding < 1e-6);
}

#[test]
fn a_search_at_a_heading_ends_when_it_is_asked_to() {
    let (ranges, vote_search) = (ranges(5, 3, 40), vote_search(Prior::Heading));
    let asked = Cell::new(0);
    let search_until = |last| {
        asked.set(0);
        let stop = || {
            asked.set(asked.get() + 1);
            asked.get() == last
        };
        vote_search.search_at(&scan(&ranges), 0.0, &stop).unwrap()
    };
    assert!(search_until(0).is_some());
    let times = asked.get();
    assert!(times > 1, "it is asked again and again: {times}");
    for last in 1..=times {
        assert_eq!(search_until(last), None);
        assert_eq!(asked.get(), last, "nothing is swept after that");
    }
}

#[test]
fn a_map_without_obstacles_or_space_is_refused() {
    let make = |rows: &[&str]| {
        let grid = grid(rows);
        VoteSearch::new(FRAME, grid, VoteSearchConfig::default(), Prior::None).map(|_| ())
    };
    assert_eq!(make(&["...", "..."]), Err(EngineError::NoOccupiedCell));
    assert_eq!(make(&["###", "#?#"]), Err(EngineError::NoFreeCell));
}

#[test]
fn a_scan_in_which_nothing_returned_has_no_votes() {
    let outcome = vote_search(Prior::None).search(&scan(&[f32::INFINITY; 9]), &|| false);
    let outcome = outcome.unwrap().unwrap();
    assert_eq!(
        (outcome.found.best, outcome.beams_used, outcome.beams_silent),
        (0, 0, 9)
    );
    let (outcome, field) = vote_search(Prior::Heading)
        .search_at(&scan(&[f32::NAN; 9]), FRAC_PI_2, &|| false)
        .unwrap()
        .unwrap();
    assert_eq!(outcome.found.votes, []);
    assert!(field.iter().all(|&intensity| intensity == 0));
}

/// One workspace for each step from a scan to its places.
#[derive(Default)]
struct All {
    vote_search: Workspace,
    peaks: peaks::Workspace,
}

/// Debug text of every result for a scan, for comparison.
fn said(all: &mut All, grid: &Grid, scan: &AnyScan, heading: Option<f64>) -> Option<String> {
    let frame = GridFrame::new(RESOLUTION_M, Pose::new(1.0, -2.0, 0.3));
    let config = VoteSearchConfig {
        headings: 48,
        votes: scan.config(),
        ..VoteSearchConfig::default()
    };
    let prior = heading.map_or(Prior::None, |_| Prior::Heading);
    let sides = (grid.width(), grid.height());
    let occupancy = occupancy_of(grid);
    let distance_field = DistanceField::new(frame, sides, &occupancy, Default::default()).unwrap();
    // Grids without obstacles or free cells are rejected.
    let vote_search = VoteSearch::new(frame, grid.clone(), config, prior).ok()?;
    let (workspace, scan) = (&mut all.vote_search, scan.scan());
    let mut text = String::new();
    match heading {
        None => text += &format!("{:?}", vote_search.block_bounds(workspace, &scan).unwrap()),
        Some(_) => {
            let found = vote_search.search_in(workspace, &scan, heading, &|| false);
            found.unwrap();
            text += &format!("{:?}", workspace.intensities());
        }
    }
    let outcome = vote_search.search_in(workspace, &scan, heading, &|| false);
    let outcome = outcome.unwrap().unwrap();
    let beams = &vote_search.config().votes.beams;
    let (input, peaks) = (PeakInput::of(outcome, frame), PeakConfig::default());
    let find = |ends: &mut Ends| ends.find(&scan, vote_search.space(), beams);
    let judged = all.peaks.judge(&input, &distance_field, &peaks, find);
    Some(text + &format!("{outcome:?} {:?}", judged.unwrap()))
}

proptest! {
    #[test]
    fn a_workspace_that_served_other_scans_and_maps_changes_nothing(
        worlds in vec((any_grid(), any_scan(), proptest::option::of(-3.0..3.0f64)), 2..6),
    ) {
        let mut all = All::default();
        for (grid, scan, heading) in &worlds {
            let fresh = said(&mut All::default(), grid, scan, *heading);
            prop_assert_eq!(said(&mut all, grid, scan, *heading), fresh);
        }
    }
}

proptest! {
    #[test]
    fn the_boundary_of_a_map_changes_nothing(grid in any_grid(), pooling in 1usize..6) {
        let rules = CellRules { unknown_blocks: grid.has_blocked(), ..CellRules::default() };
        let frame = GridFrame { resolution_m: RESOLUTION_M, map_from_grid: Pose::IDENTITY };
        let config = VoteSearchConfig {
            search_cell: RESOLUTION_M * pooling as f64,
            ..VoteSearchConfig::default()
        };
        let sides = (grid.width(), grid.height());
        let cells = occupancy_of(&grid);
        let map = Map { frame, sides, occupancy: &cells, rules };
        let prepare = || Preparation::of_map(map, config.clone(), Prior::None);
        // A map may have no obstacle or no free cell.
        if let Ok(extracted) = prepare() {
            let given = prepare().unwrap().with_boundary(&boundary::extract(&grid)).unwrap();
            prop_assert_eq!(given.key(), extracted.key());
        }
    }
}

#[test]
fn a_map_that_takes_more_memory_than_is_allowed_is_refused_with_the_figure() {
    let grid = || crate::grid::drawn::grid(&["####", "#..#", "####"]);
    let frame = GridFrame::new(0.5, Pose::IDENTITY);
    let prepare = |memory_limit, prior| {
        let config = VoteSearchConfig {
            memory_limit: Some(memory_limit),
            ..VoteSearchConfig::default()
        };
        VoteSearch::new(frame, grid(), config, prior).map(|_| ())
    };
    assert_eq!(
        prepare(1, Prior::None),
        Err(EngineError::Memory {
            needed_mb: 2,
            limit_mb: 1
        })
    );
    assert_eq!(prepare(2, Prior::None), Ok(()));
    assert_eq!(prepare(1, Prior::Heading), Ok(()), "there is no index");
}
