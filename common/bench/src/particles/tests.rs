//! A drawn world with simulated scans, in which particles find the robot.

use std::f64::consts::TAU;

use geometry::{Covariance, Pose};
use messages::Reading;

use super::drawn::distance_field;
use super::*;
use engine::EngineError;
use engine::fit::DistanceField;
use engine::particles::Candidate;

/// Two rooms and a corridor, 4 m long; without rotational or mirror symmetry.
const WORLD: [&str; 20] = [
    "########################################",
    "#...................#..................#",
    "#...................#..................#",
    "#...................#..................#",
    "#......................................#",
    "#......................................#",
    "#......................................#",
    "#...................#..........#########",
    "#...................#..................#",
    "#...................#..................#",
    "#########...#########..................#",
    "#...................#..................#",
    "#...................#.......####.......#",
    "#...................#.......####.......#",
    "#...................####################",
    "#......................................#",
    "#......................................#",
    "#..##..................................#",
    "#..##..................................#",
    "########################################",
];
const TRUTH: Pose = Pose::new(0.8, 1.35, 0.4);

/// Enough particles for every bin of the world to contain some at the start.
fn config() -> ParticlesConfig {
    ParticlesConfig {
        particles_max: 20_000,
        ..ParticlesConfig::default()
    }
}

/// Readings of a laser with a full view.
fn scan(distance_field: &DistanceField, pose: Pose) -> Vec<Reading> {
    /// Step along a ray in cells.
    const STEP: f64 = 0.05;
    let GridPose { x, y, heading } = GridPose::of(distance_field.frame, pose);
    let reading = |beam: i32| {
        let bearing = f64::from(beam) * TAU / 120.0;
        let (sin, cos) = (heading + bearing).sin_cos();
        let is_free = |cells: &f64| {
            let distance = distance_field.cell_distance(x + cells * cos, y + cells * sin);
            distance.is_some_and(|distance| distance > 0.0)
        };
        let points = (0..).map(|i| f64::from(i) * STEP);
        let cells = STEP * points.take_while(is_free).count() as f64;
        Reading {
            bearing,
            range_m: cells * distance_field.frame.resolution_m,
            weight: 1.0,
            ..Reading::default()
        }
    };
    let returned = |reading: &Reading| reading.range_m > 0.0;
    (0..120).map(reading).filter(returned).collect()
}

/// Weighs, resamples and scatters by the same scan several times; returns the last estimate.
fn gather(filter: &mut ParticleFilter, distance_field: &DistanceField, updates: usize) -> Estimate {
    let readings = scan(distance_field, TRUTH);
    for update in 0..updates {
        if update > 0 {
            filter.scatter(0.01, 0.01);
        }
        filter.weigh(distance_field, &readings);
        filter.resample();
    }
    filter.estimate().unwrap()
}

fn candidate(pose: Pose, weight: f64) -> Candidate {
    Candidate {
        map_from_target: pose,
        covariance: Covariance::from_deviations(0.05, 0.05, 0.02),
        weight,
    }
}

#[track_caller]
fn check_found(found: Estimate) {
    let pose = found.map_from_target;
    // A cell, and the turn that an end point one cell off causes at 1 m.
    assert!(pose.is_within(TRUTH, 0.1, 0.1), "{pose:?} is not {TRUTH:?}");
    assert!(found.share > 0.95, "{}", found.share);
}

#[test]
fn from_anywhere_particles_gather_where_the_robot_is() {
    let distance_field = distance_field(&WORLD);
    let mut filter =
        ParticleFilter::uniform(&distance_field, StartHeadings::Any, config()).unwrap();
    let start = filter.particles().len();
    assert!(start > 5000, "a bin for each 0.25 m² and 10°: {start}");
    check_found(gather(&mut filter, &distance_field, 21));
    let end = filter.particles().len();
    assert!(end < 2000, "gathered particles are fewer: {end}");
}

#[test]
fn a_start_at_the_places_of_the_votes_is_right_at_once() {
    let distance_field = distance_field(&WORLD);
    let wrong = Pose::new(3.0, 0.3, 2.0);
    let candidates = [candidate(wrong, 0.5), candidate(TRUTH, 0.5)];
    let mut filter = ParticleFilter::seeded(distance_field.frame, candidates, config()).unwrap();
    assert!(filter.particles().len() < 2000);
    check_found(gather(&mut filter, &distance_field, 1));
    let refused = ParticleFilter::seeded(distance_field.frame, [], config());
    assert_eq!(refused.err(), Some(EngineError::NoStart));
}

#[test]
fn the_same_seed_gives_the_same_particles() {
    let distance_field = distance_field(&WORLD);
    let particles = |seed| {
        let config = ParticlesConfig {
            particles_seed: seed,
            ..config()
        };
        let mut filter =
            ParticleFilter::uniform(&distance_field, StartHeadings::Any, config).unwrap();
        let estimate = gather(&mut filter, &distance_field, 6);
        (estimate, filter.particles().to_vec())
    };
    assert_eq!(particles(3), particles(3));
    assert_ne!(particles(3).1, particles(4).1);
}

#[test]
fn scatter_has_the_deviations_that_are_asked_for() {
    let distance_field = distance_field(&WORLD);
    let config = ParticlesConfig {
        particles_min: 20_000,
        ..config()
    };
    let mut filter =
        ParticleFilter::seeded(distance_field.frame, [candidate(TRUTH, 1.0)], config).unwrap();
    let before = filter.particles().to_vec();
    filter.scatter(0.2, 0.0);
    let pairs = || before.iter().zip(filter.particles());
    assert!(pairs().all(|(a, b)| a.pose.heading == b.pose.heading));
    for of in [|p: &GridPose| p.x, |p: &GridPose| p.y] {
        let squares = pairs().map(|(a, b)| (of(&b.pose) - of(&a.pose)).powi(2));
        let deviation = (squares.sum::<f64>() / before.len() as f64).sqrt();
        // Two cells, within 3 %: six standard errors of 1 / √(2 · 20000).
        assert!((deviation - 2.0).abs() < 0.06, "{deviation}");
    }
}

#[test]
fn even_weights_are_not_drawn_again() {
    let distance_field = distance_field(&WORLD);
    let mut filter =
        ParticleFilter::seeded(distance_field.frame, [candidate(TRUTH, 1.0)], config()).unwrap();
    let before = filter.particles().to_vec();
    assert!(!filter.resample());
    filter.weigh(&distance_field, &[]);
    assert_eq!(filter.particles(), before, "nothing was seen");
    assert_eq!(filter.effective_number(), before.len() as f64);
}
