//! People and glass: changes that stand in the world, or move with the robot.

use std::hash::{DefaultHasher, Hash, Hasher};

use geometry::Pose;
use offline::TakenScan;
use rand::RngExt;
use simulation::Obstacles;

use super::material::Material;
use super::material::{Change, Means};

/// Radius of a person (a disc), distance from the laser and from the robot's path, in metres.
const RADIUS_M: f64 = 0.2;
const STANDS_M: std::ops::Range<f64> = 0.7..3.0;
const FROM_WAY_M: f64 = 0.5;

/// Maximum number of positions tried for people.
const MAX_TRIES: u32 = 1000;

/// Distance beyond which a person is ignored, metres.
const SEEN_M: f64 = 8.0;

/// A crowd: distance from the laser (metres), degrees of view per person, and amplitude and speed
/// of its sway (radians, and radians per scan).
const CROWD_M: std::ops::Range<f64> = 0.6..1.2;
const CROWD_DEG: f64 = 30.0;
const SWAY: (f64, f64) = (0.15, 0.05);

/// Side of the wall squares that are glass or not (metres), share of glass (per cent), and distance
/// after which a beam through glass continues (metres).
const GLASS_M: f64 = 1.0;
const GLASS: u64 = 25;
const BEHIND_M: f64 = 0.3;

type Place = (f64, f64);

/// Bearing of a reading, in radians, seen from above.
fn bearing(scan: &TakenScan, i: usize) -> f64 {
    let message = &scan.message;
    let side = if scan.upside_down { -1.0 } else { 1.0 };
    side * (f64::from(message.angle_min) + i as f64 * f64::from(message.angle_increment))
}

/// Changes the scans of all lasers, given the pose of each.
fn each(it: &mut Material, mut change: impl FnMut(&mut TakenScan, Pose)) {
    for step in &mut it.steps {
        let at = step.map_from_laser;
        let base = at.then(step.scan.base_from_laser.unwrap_or_default().inverse());
        for other in &mut step.scan.others {
            let laser = base.then(other.base_from_laser.unwrap_or_default());
            change(other, laser);
        }
        change(&mut step.scan, at);
    }
}

/// Range of a beam to the nearest of these people, in the laser's frame.
fn range_to(people: &[Place], bearing: f64) -> f64 {
    let (sin, cos) = bearing.sin_cos();
    let ranges = people.iter().filter_map(|&(x, y)| {
        let (along, across) = (x * cos + y * sin, y * cos - x * sin);
        // NaN if the beam misses.
        let range = along - (RADIUS_M * RADIUS_M - across * across).sqrt();
        (range > 0.0).then_some(range)
    });
    ranges.fold(f64::INFINITY, f64::min)
}

/// Puts people, in the laser's frame, before it; returns the share of the beams that they hide.
fn hide(scan: &mut TakenScan, people: &[Place]) -> f64 {
    let mut hidden = 0;
    for i in 0..scan.message.ranges.len() {
        let range_m = range_to(people, bearing(scan, i)) as f32;
        let reading = &mut scan.message.ranges[i];
        let is_hidden = range_m < *reading || (reading.is_nan() && range_m.is_finite());
        if is_hidden {
            *reading = range_m;
            hidden += 1;
        }
    }
    f64::from(hidden) / scan.message.ranges.len().max(1) as f64
}

fn seen_from(people: &[Place], at: Pose) -> Vec<Place> {
    let from = at.inverse();
    let seen = people.iter().map(|&(x, y)| from.transform(x, y));
    seen.filter(|(x, y)| x.hypot(*y) < SEEN_M).collect()
}

/// Puts people along the path until they hide this share of the beams of all scans.
pub(super) fn stand_people(it: &mut Material, means: &mut Means<'_>, share: f64) -> Change<()> {
    let mut people = Vec::new();
    // A hundred scans are enough to estimate the share.
    let every = it.steps.len().div_ceil(100).max(1);
    let looked_at: Vec<usize> = (0..it.steps.len()).step_by(every).collect();
    for _ in 0..MAX_TRIES {
        let hidden: f64 = looked_at.iter().map(|&i| hidden_at(it, i, &people)).sum();
        if hidden >= 0.95 * share * looked_at.len() as f64 {
            break;
        }
        let i = looked_at[means.rng.random_range(0..looked_at.len())];
        if hidden_at(it, i, &people) < share {
            people.extend(person_near(it, means, i));
        }
    }
    each(it, |scan, at| {
        hide(scan, &seen_from(&people, at));
    });
    Ok(())
}

fn hidden_at(it: &Material, i: usize, people: &[Place]) -> f64 {
    let step = &it.steps[i];
    hide(
        &mut step.scan.clone(),
        &seen_from(people, step.map_from_laser),
    )
}

/// Returns a position that a scan sees as free, away from the robot's path.
fn person_near(it: &Material, means: &mut Means<'_>, i: usize) -> Option<Place> {
    let (step, beams) = (&it.steps[i], it.steps[i].scan.message.ranges.len());
    let beam = means.rng.random_range(0..beams.max(1));
    let away_m: f64 = means.rng.random_range(STANDS_M);
    let reading = f64::from(*step.scan.message.ranges.get(beam)?);
    let bearing = bearing(&step.scan, beam);
    let place = step
        .map_from_laser
        .transform(away_m * bearing.cos(), away_m * bearing.sin());
    let is_near = |at: Pose| (at.x - place.0).hypot(at.y - place.1) < FROM_WAY_M;
    let is_free =
        reading > away_m + RADIUS_M && !it.steps.iter().any(|s| is_near(s.map_from_laser));
    is_free.then_some(place)
}

/// Surrounds the robot by a crowd that moves along.
pub(super) fn walk_along(it: &mut Material, means: &mut Means<'_>) -> Change<()> {
    let people: Vec<[f64; 3]> = (0..(360.0 / CROWD_DEG) as u32)
        .map(|i| {
            let bearing = (f64::from(i) * CROWD_DEG).to_radians();
            let phase = means.rng.random_range(0.0..std::f64::consts::TAU);
            [bearing, means.rng.random_range(CROWD_M), phase]
        })
        .collect();
    let mut scans = 0.0;
    each(it, |scan, _| {
        let places: Vec<Place> = people
            .iter()
            .map(|[bearing, away_m, phase]| {
                let sway = SWAY.0 * (phase + SWAY.1 * scans).sin();
                let (bearing, away_m) = (bearing + sway, away_m + sway);
                (away_m * bearing.cos(), away_m * bearing.sin())
            })
            .collect();
        hide(scan, &places);
        scans += 1.0;
    });
    Ok(())
}

/// Makes some walls glass: beams return nothing or, if `is_clear`, the obstacle behind.
pub(super) fn glaze(it: &mut Material, means: &mut Means<'_>, is_clear: bool) -> Change<()> {
    let salt: u64 = means.rng.random();
    let is_glass = |(x, y): Place| {
        let square = ((x / GLASS_M).floor() as i64, (y / GLASS_M).floor() as i64);
        let mut hasher = DefaultHasher::new();
        (salt, square).hash(&mut hasher);
        hasher.finish() % 100 < GLASS
    };
    let obstacles = Obstacles::of(&it.map);
    each(it, |scan, at| {
        let range_max_m = f64::from(scan.message.range_max);
        for i in 0..scan.message.ranges.len() {
            let (bearing, range_m) = (bearing(scan, i), f64::from(scan.message.ranges[i]));
            let (sin, cos) = bearing.sin_cos();
            let is_wall = range_m.is_finite() && range_m < range_max_m;
            if !is_wall || !is_glass(at.transform(range_m * cos, range_m * sin)) {
                continue;
            }
            let behind_m = range_m + BEHIND_M;
            let (x, y) = at.transform(behind_m * cos, behind_m * sin);
            let next = obstacles.range(x, y, at.yaw + bearing, range_max_m - behind_m);
            let seen = next
                .filter(|_| is_clear)
                .map(|next| (behind_m + next) as f32);
            scan.message.ranges[i] = seen.unwrap_or(f32::INFINITY);
        }
    });
    Ok(())
}
