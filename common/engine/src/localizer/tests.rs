use std::cell::Cell;
use std::f64::consts::{FRAC_PI_2, PI};

use geometry::Pose;

use super::*;
use crate::grid::drawn::grid;
use crate::reference;

/// An L-shaped room with a pillar: no pose looks like another.
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
const FRAME: GridFrame = GridFrame {
    resolution_m: 0.25,
    map_from_grid: Pose::new(3.0, -1.0, 0.5),
};

fn localizer(prior: Prior) -> Localizer {
    let grid = grid(&ROOM);
    Localizer::new(FRAME, grid, LocalizerConfig::default(), prior).unwrap()
}

/// What a laser with a beam a degree all around reads at a pose of the grid.
fn ranges(x: i64, y: i64, heading: usize) -> Vec<f32> {
    let grid = grid(&ROOM);
    let space = Space::new(360, FRAME.resolution_m, grid.width(), grid.height()).unwrap();
    let beams = (0..360).map(|beam| {
        let direction = space.directions.get(heading + 180 + beam);
        reference::range(&grid, x, y, direction).map_or(f32::INFINITY, |steps| {
            (f64::from(steps) / direction.steps_per_cell * FRAME.resolution_m) as f32
        })
    });
    beams.collect()
}

fn scan(ranges: &[f32]) -> Scan<'_> {
    let angle_increment = 1f64.to_radians();
    Scan {
        angle_min: -PI,
        angle_increment,
        range_min_m: 0.0,
        range_max_m: 30.0,
        ranges,
    }
}

#[test]
fn finds_the_pose_that_a_scan_was_taken_at() {
    let ranges = ranges(5, 3, 40);
    let outcome = localizer(Prior::None)
        .search(&scan(&ranges), &|| false)
        .unwrap()
        .unwrap();
    let best = outcome.found.votes[0];
    assert_eq!((best.x, best.y, best.heading), (5, 3, 40));
    assert_eq!(
        u32::from(best.intensity),
        outcome.highest_possible,
        "every beam agrees"
    );
}

#[test]
fn a_known_heading_is_taken_in_the_map_frame() {
    let ranges = ranges(5, 3, 40);
    let heading = 40f64.to_radians() + 0.5;
    let (outcome, field) = localizer(Prior::Heading)
        .search_at(&scan(&ranges), heading, &|| false)
        .unwrap()
        .unwrap();
    let best = outcome.found.votes[0];
    assert_eq!((best.x, best.y, best.heading), (5, 3, 40));
    assert_eq!(field[3 * 20 + 5], best.intensity);
    assert!(outcome.bearing_rounding < 1e-6);
}

#[test]
fn a_search_at_a_heading_ends_when_it_is_told_to() {
    let (ranges, localizer) = (ranges(5, 3, 40), localizer(Prior::Heading));
    let asked = Cell::new(0);
    let search_until = |last| {
        asked.set(0);
        let stop = || {
            asked.set(asked.get() + 1);
            asked.get() == last
        };
        localizer.search_at(&scan(&ranges), 0.0, &stop).unwrap()
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
        Localizer::new(FRAME, grid, LocalizerConfig::default(), Prior::None).map(|_| ())
    };
    assert_eq!(make(&["...", "..."]), Err(EngineError::NoOccupiedCell));
    assert_eq!(make(&["###", "#?#"]), Err(EngineError::NoFreeCell));
}

#[test]
fn a_scan_in_which_nothing_returned_has_no_votes() {
    let outcome = localizer(Prior::None).search(&scan(&[f32::INFINITY; 9]), &|| false);
    let outcome = outcome.unwrap().unwrap();
    assert_eq!(
        (outcome.found.best, outcome.beams_used, outcome.beams_silent),
        (0, 0, 9)
    );
    let (outcome, field) = localizer(Prior::Heading)
        .search_at(&scan(&[f32::NAN; 9]), FRAC_PI_2, &|| false)
        .unwrap()
        .unwrap();
    assert_eq!(outcome.found.votes, []);
    assert!(field.iter().all(|&intensity| intensity == 0));
}
