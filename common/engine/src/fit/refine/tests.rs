use proptest::collection::vec;
use proptest::prelude::*;

use super::super::drawn::{distance_field, field_of};
use super::*;
use crate::fit::distance_field::{LANES, lanes};
use crate::fit::ends::End;
use crate::instruction_set::InstructionSet;

/// An L-shaped room, 20 cells wide.
const ROOM: [&str; 12] = [
    "####################",
    "#..................#",
    "#..................#",
    "#..................#",
    "#..................#",
    "#..................#",
    "#..................#",
    "#.......############",
    "#.......#...........",
    "#.......#...........",
    "#.......#...........",
    "#########...........",
];
const TRUTH: GridPose = GridPose::new(5.25, 7.75, 0.3);

/// Scan of a laser at the pose, with readings up to the middle of the walls.
fn scan(rows: &[&str], pose: GridPose) -> Ends {
    let map = distance_field(rows);
    let end = |beam: i32| {
        let angle = f64::from(beam).to_radians();
        let (dy, dx) = (pose.heading + angle).sin_cos();
        let is_at_wall = |reading: &f64| {
            let at = map.distance(pose.x + reading * dx, pose.y + reading * dy);
            at.is_some_and(|distance| distance < 0.05)
        };
        let reading = (0..4000)
            .map(|step| 0.01 * f64::from(step))
            .find(is_at_wall)?;
        Some(End::new((0.0, 0.0), angle, (0.1 * reading, reading), 1.0))
    };
    let ends = (-180..180).step_by(3).filter_map(end);
    Ends::of(ends.collect())
}

#[test]
fn a_pose_nearby_is_moved_to_where_the_scan_was_taken() {
    let (map, ends) = (distance_field(&ROOM), scan(&ROOM, TRUTH));
    for (x, y, turn) in [(0.0, 0.0, 0.0), (0.7, -0.6, 0.03), (-0.8, 0.5, -0.05)] {
        let start = GridPose::new(TRUTH.x + x, TRUTH.y + y, TRUTH.heading + turn);
        let refined = map.refine(&ends, start, false, &FitConfig::default());
        let off = (refined.pose.x - TRUTH.x).hypot(refined.pose.y - TRUTH.y);
        // Readings end up to 0.05 cells before the middle of a wall.
        assert!(off < 0.1, "{off} cells from {start:?}");
        assert!((refined.pose.heading - TRUTH.heading).abs() < 0.01);
        assert!(refined.variance < 0.05 && refined.weight > 0.9 * ends.weight);
    }
}

#[test]
fn a_known_heading_is_left_alone() {
    let (map, ends) = (distance_field(&ROOM), scan(&ROOM, TRUTH));
    let start = GridPose {
        x: TRUTH.x + 0.5,
        ..TRUTH
    };
    let refined = map.refine(&ends, start, true, &FitConfig::default());
    assert_eq!(refined.pose.heading, TRUTH.heading);
    assert!((refined.pose.x - TRUTH.x).abs() < 0.1);
}

#[test]
fn what_no_beam_shows_stays_as_it_was() {
    const CORRIDOR: [&str; 5] = [
        "##############################",
        "..............................",
        "..............................",
        "..............................",
        "##############################",
    ];
    let pose = GridPose::new(15.0, 2.5, 0.0);
    let (map, ends) = (distance_field(&CORRIDOR), scan(&CORRIDOR, pose));
    let start = GridPose {
        x: 13.0,
        y: 2.9,
        ..pose
    };
    let refined = map.refine(&ends, start, false, &FitConfig::default());
    // Ends at the corridor's far ends constrain x a little.
    assert!((refined.pose.x - 13.0).abs() < 0.5, "{:?}", refined.pose);
    assert!((refined.pose.y - 2.5).abs() < 0.1);
    assert!(refined.curvature[(0, 0)] < 0.05 * refined.curvature[(1, 1)]);
}

/// Standard deviations that errors of walls add to a pose, given the derivatives of its ends'
/// distances.
fn by_walls(pulls: &[[f64; 3]], drawn: f64) -> [f64; 3] {
    let (mut lane_sums, mut walls) = (LaneSums::default(), Walls::default());
    for slope in pulls {
        let one = Pulls {
            weight: lanes(|i| f32::from(u8::from(i == 0))),
            distance: [0.5; LANES],
            slope: slope.map(|slope| [slope as f32; LANES]),
        };
        lane_sums.add(&one);
        walls.add(&one);
    }
    let sums = lane_sums.sums();
    let refined = Refined {
        pose: TRUTH,
        curvature: sums.curvature() + 1e-9 * Matrix3::identity(),
        variance: 0.25,
        weight: sums.weight,
        walls: walls.products(),
    };
    let covariance = refined.information().try_inverse().unwrap();
    let added = refined.by_walls(covariance, drawn);
    std::array::from_fn(|i| added[(i, i)].sqrt())
}

#[test]
fn a_wall_that_is_off_moves_the_pose_however_many_beams_end_there() {
    // One wall, ahead along x: the pose is off by as much as the wall.
    for beams in [10, 1000] {
        let one = vec![[1.0, 0.0, 0.0]; beams];
        assert!((by_walls(&one, 0.0)[0] - 0.5).abs() < 1e-6);
        assert!((by_walls(&one, 1.2)[0] - 1.3).abs() < 1e-6);
    }
    // Two walls that face each other are off independently: their mean is off by 1/√2 of that.
    let both = [[[1.0, 0.0, 0.0]; 40], [[-1.0, 0.0, 0.0]; 40]].concat();
    assert!((by_walls(&both, 0.0)[0] - 0.5 / 2f64.sqrt()).abs() < 1e-6);
    // Parts of a wall that is almost parallel to an axis are one wall.
    let bent = [[[1.0, 0.1, 0.0]; 40], [[1.0, -0.1, 0.0]; 40]].concat();
    assert!((by_walls(&bent, 0.0)[0] - 0.5).abs() < 0.01);
}

#[test]
fn a_scan_without_beams_moves_nothing() {
    let none = Ends::of(Vec::new());
    let refined = distance_field(&ROOM).refine(&none, TRUTH, false, &FitConfig::default());
    assert_eq!((refined.pose, refined.weight), (TRUTH, 0.0));
}

#[test]
fn a_reading_beyond_all_maps_has_no_say() {
    let (map, ends) = (distance_field(&ROOM), scan(&ROOM, TRUTH));
    let expected = map.refine(&ends, TRUTH, false, &FitConfig::default());
    for reading in [2e6, 1e20, 1e30, 1e39, 1e300, f64::INFINITY] {
        let far = [0.0, 0.7].map(|angle| End::new((0.0, 0.0), angle, (reading, reading), 1.0));
        let with_far = Ends::of([&ends.ends[..], &far].concat());
        let refined = map.refine(&with_far, TRUTH, false, &FitConfig::default());
        let off = (refined.pose.x - expected.pose.x).hypot(refined.pose.y - expected.pose.y);
        assert!(off < 0.01, "{reading}: {refined:?}");
        assert!(
            (refined.weight - expected.weight).abs() < 0.1,
            "{reading}: {refined:?}"
        );
        let sums = [refined.curvature, refined.walls];
        let are_finite = sums
            .iter()
            .all(|sums| sums.iter().all(|sum| sum.is_finite()));
        assert!(
            are_finite && refined.variance.is_finite(),
            "{reading}: {refined:?}"
        );
    }
}

proptest! {
    #[test]
    fn every_instruction_set_refines_to_the_same_bit(
        grid in crate::testing::any_grid(),
        beams in vec((-180.0..180.0f64, 0.5..50.0f64, 0.1..1.0f64), 1..=20),
        (x, y, heading) in (-2.0..42.0f64, -2.0..42.0f64, -4.0..4.0f64),
        heading_is_known: bool,
    ) {
        let end = |(degrees, reading, weight): (f64, f64, f64)| {
            End::new((0.5, -0.2), degrees.to_radians(), (0.1 * reading, reading), weight)
        };
        let ends = Ends::of(beams.into_iter().map(end).collect());
        let start = GridPose { x, y, heading };
        let refined = |set| {
            let map = field_of(&grid).with(set);
            let found = map.refine(&ends, start, heading_is_known, &FitConfig::default());
            let pose = [found.pose.x, found.pose.y, found.pose.heading];
            let numbers = pose.into_iter().chain([found.variance, found.weight]);
            let sums = found.curvature.iter().chain(&found.walls).copied();
            numbers.chain(sums).map(f64::to_bits).collect::<Vec<_>>()
        };
        let expected = refined(InstructionSet::Portable);
        for set in InstructionSet::available() {
            prop_assert_eq!(refined(set), expected.clone(), "{}", set);
        }
    }
}
