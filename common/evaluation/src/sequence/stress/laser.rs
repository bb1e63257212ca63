//! Changes of the readings that do not depend on the world.

use std::f32::consts::{PI, TAU};

use rand::RngExt;
use rand_distr::{Distribution, StandardNormal};
use ros::LaserScan;

use super::material::Material;
use super::material::{Change, Means};

/// Error of the laser's mount: metres to the left, and degrees.
const OFF: (f32, f32) = (0.05, 2.0);

/// Ranges of a covered laser in the first and second half of the drive, and their spread, metres.
const COVERED_M: [f32; 2] = [1.0, 0.5];
const SPREAD_M: f32 = 0.01;

/// Share of the readings that return early.
const EARLY: f64 = 0.1;

/// Changes the scans of all lasers.
fn each(it: &mut Material, mut change: impl FnMut(&mut LaserScan)) {
    for step in &mut it.steps {
        change(&mut step.scan.message);
        for other in &mut step.scan.others {
            change(&mut other.message);
        }
    }
}

/// Mirrors the bearings; no pose is right.
pub(super) fn mirror(it: &mut Material) -> Change<()> {
    each(it, |scan| {
        scan.angle_min = -scan.angle_min;
        scan.angle_max = -scan.angle_max;
        scan.angle_increment = -scan.angle_increment;
    });
    it.is_nowhere = true;
    Ok(())
}

/// Turns the laser by 180°, not its mount: a base that is found turned is wrong.
pub(super) fn turn(it: &mut Material) -> Change<()> {
    each(it, |scan| {
        let by = if scan.angle_min > 0.0 { -PI } else { PI };
        scan.angle_min += by;
        scan.angle_max += by;
    });
    Ok(())
}

/// Moves and turns the laser slightly from its stated mount.
pub(super) fn shift(it: &mut Material) -> Change<()> {
    each(it, |scan| {
        let turn = OFF.1.to_radians();
        let beams = scan.ranges.len() as f32;
        let mut ranges = vec![f32::INFINITY; scan.ranges.len()];
        let all = scan.ranges.iter().enumerate();
        for (i, &range) in all.filter(|(_, range)| range.is_finite()) {
            let bearing = scan.angle_min + i as f32 * scan.angle_increment;
            let (x, y) = (range * bearing.cos(), range * bearing.sin() - OFF.0);
            let beyond = (y.atan2(x) - turn - scan.angle_min).rem_euclid(TAU);
            let along = if scan.angle_increment < 0.0 {
                TAU - beyond
            } else {
                beyond
            };
            // An angle just before the first beam rounds to the first beam.
            let steps = along / scan.angle_increment.abs();
            let beam = if TAU / scan.angle_increment.abs() - steps < 0.5 {
                0.0
            } else {
                steps.round()
            };
            if beam < beams {
                let nearest: &mut f32 = &mut ranges[beam as usize];
                *nearest = nearest.min(x.hypot(y));
            }
        }
        scan.ranges = ranges;
    });
    Ok(())
}

/// Repeats the same scan with new stamps from mid-drive on.
pub(super) fn freeze(it: &mut Material) -> Change<()> {
    let middle = it.steps.len() / 2;
    let (before, after) = it.steps.split_at_mut(middle);
    let Some(last) = before.last() else {
        return Err("the drive has one scan");
    };
    for step in after {
        let ranges = &last.scan.message.ranges;
        step.scan.message.ranges.clone_from(ranges);
        for (other, last) in step.scan.others.iter_mut().zip(&last.scan.others) {
            other.message.ranges.clone_from(&last.message.ranges);
        }
    }
    Ok(())
}

pub(super) fn cover(it: &mut Material, means: &mut Means<'_>) -> Change<()> {
    let (mut number, scans) = (0, it.steps.len());
    for step in &mut it.steps {
        let middle_m = COVERED_M[usize::from(2 * number >= scans)];
        number += 1;
        let others = step.scan.others.iter_mut().map(|other| &mut other.message);
        for scan in others.chain([&mut step.scan.message]) {
            for range in &mut scan.ranges {
                *range = middle_m + means.rng.random_range(-SPREAD_M..SPREAD_M);
            }
        }
    }
    Ok(())
}

/// Narrows the field of view to its middle part.
pub(super) fn narrow(it: &mut Material, degrees: f32) -> Change<()> {
    let mut is_narrowed = false;
    each(it, |scan| {
        let beams = scan.ranges.len();
        let seen = (degrees.to_radians() / scan.angle_increment.abs()).round() as usize + 1;
        if seen >= beams {
            return;
        }
        is_narrowed = true;
        let first = (beams - seen) / 2;
        scan.ranges = scan.ranges[first..first + seen].to_vec();
        scan.angle_min += first as f32 * scan.angle_increment;
        scan.angle_max = scan.angle_min + (seen - 1) as f32 * scan.angle_increment;
        scan.intensities.clear();
    });
    is_narrowed.then_some(()).ok_or("it sees no more than that")
}

pub(super) fn shorten(it: &mut Material, metres: f32) -> Change<()> {
    each(it, |scan| {
        scan.range_max = scan.range_max.min(metres);
        let beyond = scan.ranges.iter_mut().filter(|range| **range >= metres);
        beyond.for_each(|range| *range = f32::INFINITY);
    });
    Ok(())
}

/// Reduces the number of beams to about `beams`.
pub(super) fn thin(it: &mut Material, beams: usize) -> Change<()> {
    let mut is_thinned = false;
    each(it, |scan| {
        let every = (scan.ranges.len() - 1).div_ceil(beams - 1).max(1);
        is_thinned |= every > 1;
        scan.ranges = scan.ranges.iter().copied().step_by(every).collect();
        scan.angle_increment *= every as f32;
        scan.time_increment *= every as f32;
        scan.intensities.clear();
    });
    is_thinned.then_some(()).ok_or("it has no more beams")
}

/// Adds normal errors with this standard deviation to the readings, metres.
pub(super) fn add_noise(it: &mut Material, means: &mut Means<'_>, sigma_m: f32) -> Change<()> {
    each(it, |scan| noise(scan, means, sigma_m));
    Ok(())
}

pub(super) fn noise(scan: &mut LaserScan, means: &mut Means<'_>, sigma_m: f32) {
    for range in scan.ranges.iter_mut().filter(|range| range.is_finite()) {
        let error: f32 = StandardNormal.sample(&mut means.rng);
        *range = (*range + sigma_m * error).max(0.0);
    }
}

/// Replaces some readings by random shorter ones, as in rain or dust.
pub(super) fn return_early(it: &mut Material, means: &mut Means<'_>) -> Change<()> {
    each(it, |scan| {
        for range in &mut scan.ranges {
            let most = range.min(scan.range_max);
            if most > 0.1 && means.rng.random_bool(EARLY) {
                *range = means.rng.random_range(0.1..most);
            }
        }
    });
    Ok(())
}
