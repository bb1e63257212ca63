use std::f64::consts::FRAC_PI_2;

use super::*;
use crate::beams::BeamConfig;
use crate::grid::{CellRules, drawn};
use crate::space::Space;
use crate::testing::{ranges_at, scan_around, vote};

const FRAME: GridFrame = GridFrame::new(0.1, Pose::new(0.0, 0.0, FRAC_PI_2));

/// A room in which every pose is distinguishable.
const ROOM: [&str; 20] = [
    "########################################",
    "#......................................#",
    "#......................................#",
    "#......................................#",
    "#......................................#",
    "#......................................#",
    "#.................###..................#",
    "#.................###..................#",
    "#......................................#",
    "#......................................#",
    "#......................................#",
    "#......................................#",
    "#.............##########################",
    "#.............#.........................",
    "#.............#.........................",
    "#......##.....#.........................",
    "#......##.....#.........................",
    "#.............#.........................",
    "#.............#.........................",
    "###############.........................",
];

const WALL: &str = "########################################";
const OPEN: &str = "#......................................#";

/// A hall that looks the same when it is turned by half.
const HALL: [&str; 12] = [
    WALL, OPEN, OPEN, OPEN, OPEN, OPEN, OPEN, OPEN, OPEN, OPEN, OPEN, WALL,
];

/// Places of a scan in a drawn building.
fn places(rows: &[&str], ranges: &[f32], input: &PeakInput<'_>) -> Places {
    let (width, height, occupancy) = drawn::occupancy(rows);
    let sides = (width, height);
    let field = DistanceField::new(FRAME, sides, &occupancy, CellRules::default()).unwrap();
    let space = Space::new(360, FRAME.resolution_m, width, height).unwrap();
    let (scan, beams) = (scan_around(ranges), BeamConfig::default());
    let find = |ends: &mut Ends| ends.find(&scan, &space, &beams);
    let mut workspace = Workspace::default();
    let judged = workspace.judge(input, &field, &PeakConfig::default(), find);
    judged.unwrap().places.clone()
}

fn ranges(rows: &[&str], at: (i64, i64, usize)) -> Vec<f32> {
    ranges_at(&drawn::grid(rows), FRAME.resolution_m, at)
}

fn input(votes: &[Vote]) -> PeakInput<'_> {
    PeakInput {
        votes,
        certified_floor: 85,
        cut: false,
        highest_possible: 200,
        lead: votes.first().map_or(0, |vote| vote.intensity.into()),
        has_others: false,
        headings: 360,
        known_heading: None,
        frame: FRAME,
    }
}

#[test]
fn no_votes_are_no_scan() {
    let places = places(&ROOM, &[f32::INFINITY; 360], &input(&[]));
    assert_eq!(places, Places::default());
    assert_eq!(places.verdict, Verdict::NoScan);
}

#[test]
fn votes_close_by_are_one_place_refined_to_the_pose_of_the_scan() {
    let votes = [
        vote(6, 13, 41, 100),
        vote(5, 12, 39, 99),
        vote(7, 13, 40, 99),
        vote(30, 12, 200, 60),
    ];
    let places = places(&ROOM, &ranges(&ROOM, (6, 12, 40)), &input(&votes));
    assert_eq!((places.verdict, places.alternatives), (Verdict::Unique, 0));
    let best = places.places[0];
    // The middle of cell (6, 12) of a grid that is turned by a quarter: x is -y, y is x. Ranges end
    // anywhere in the cells of walls.
    let truth = Pose::new(-1.25, 0.65, FRAC_PI_2 + 40f64.to_radians());
    assert!(
        best.map_from_laser.is_within(truth, 0.05, 0.02),
        "{:?}",
        best.map_from_laser
    );
    assert_eq!((best.intensity, best.support), (100, 3));
    assert!(best.score > 0.9, "{}", best.score);
    assert_eq!(places.confidence, best.probability);
}

#[test]
fn equal_places_are_ambiguous_and_weak_ones_fit_poorly() {
    let votes = [vote(10, 4, 0, 100), vote(29, 7, 180, 98)];
    let taken = ranges(&HALL, (10, 4, 0));
    let equal = places(&HALL, &taken, &input(&votes));
    assert_eq!(
        (equal.verdict, equal.alternatives, equal.places.len()),
        (Verdict::Ambiguous, 1, 2)
    );
    assert!((0.4..=0.6).contains(&equal.confidence), "{equal:?}");
    let half: Vec<f32> = taken.iter().map(|range| range / 2.0).collect();
    let weak = places(&HALL, &half, &input(&votes));
    assert_eq!(weak.verdict, Verdict::PoorFit);
}

#[test]
fn a_cut_search_is_unique_only_where_no_rival_can_have_been_missed() {
    let votes = [vote(6, 12, 40, 100), vote(30, 12, 200, 60)];
    let ranges = ranges(&ROOM, (6, 12, 40));
    let verdict = |cut, certified_floor| {
        let input = PeakInput {
            cut,
            certified_floor,
            ..input(&votes)
        };
        places(&ROOM, &ranges, &input).verdict
    };
    // Rivals have at least 92 votes, and poses with one less than the floor may be missing.
    assert_eq!(verdict(true, 92), Verdict::Unique);
    assert_eq!(verdict(true, 93), Verdict::Ambiguous);
    assert_eq!(verdict(true, 180), Verdict::Ambiguous);
    assert_eq!(verdict(false, 93), Verdict::Unique);
}

#[test]
fn a_known_heading_is_kept_as_given() {
    let votes = [vote(6, 12, 40, 100)];
    let heading = FRAC_PI_2 + 41f64.to_radians();
    let known = PeakInput {
        known_heading: Some(heading),
        ..input(&votes)
    };
    let best = places(&ROOM, &ranges(&ROOM, (6, 12, 40)), &known).places[0];
    assert_eq!(best.map_from_laser.yaw, heading);
    assert_eq!(best.covariance.to_rows()[8], 0.0);
}
