//! Checks that the map has the scale of the scans, and that the robot's base is on free cells.

use engine::grid::CellRules;
use geometry::Pose;

use super::drive::is_far;
use super::finding::Finding;
use super::located::{AS_MEASURED, Located, LocatedScan, SCALES};

/// Smallest number of scans that distinguish a fault from chance.
const MIN_SCANS: usize = 5;

/// Smallest gain of the mean score at another scale that shows that the map has that scale: it is
/// at most 0.01 on maps of the right size, both measured and drawn, and 0.1 or more on those that
/// are 2 % too large.
const BETTER_FIT: f64 = 0.03;

/// Share of the poses that must show the same fault.
const MIN_SHARE: f64 = 0.5;

/// On a map of another place, scans have at most this mean score, and scores at different scales
/// differ by at most this: scores of 0.4 to 0.65, within 0.05, for five pairs of drives and maps.
const NOWHERE_FIT: f64 = 0.7;
const NOWHERE_SPREAD: f64 = 0.1;

/// Returns the first finding, without its consequences.
pub(super) fn first(located: &Located) -> Option<Finding> {
    let checks = [elsewhere, scale, base_in_wall];
    checks.into_iter().find_map(|check| check(located))
}

/// Mean score of scans at each of [`SCALES`]; `None` if there are too few scans.
fn means(located: &Located) -> Option<[f64; SCALES.len()]> {
    let count = located.by_scale.len();
    let mean = |i: usize| {
        let scores = located.by_scale.iter().map(|scores| scores[i]);
        scores.sum::<f64>() / count as f64
    };
    (count >= MIN_SCANS).then(|| std::array::from_fn(mean))
}

fn elsewhere(located: &Located) -> Option<Finding> {
    let means = means(located)?;
    let (least, most) = means.iter().fold((1.0f64, 0.0f64), |(least, most), &mean| {
        (least.min(mean), most.max(mean))
    });
    let is_known = located.scans.iter().any(|found| found.is_unique);
    let is_elsewhere = !is_known && most < NOWHERE_FIT && most - least < NOWHERE_SPREAD;
    is_elsewhere.then(|| {
        Finding::problem(format!(
            "none of {} scans has a place on the map, which they fit by {:.2} on average and at \
             other scales as badly: use the map of the place where this was recorded",
            located.scans.len(),
            means[AS_MEASURED]
        ))
    })
}

fn scale(located: &Located) -> Option<Finding> {
    let means = means(located)?;
    let best = (0..SCALES.len()).max_by(|&a, &b| means[a].total_cmp(&means[b]))?;
    (means[best] > means[AS_MEASURED] + BETTER_FIT).then(|| {
        let scale = top(&means, best);
        let resolution_m = located.map.resolution_m;
        let right_m = resolution_m / scale;
        let percent = 100.0 * (scale - 1.0).abs();
        let size = if scale > 1.0 { "larger" } else { "smaller" };
        Finding::problem(format!(
            "the map is about {percent:.0} % {size} than what the laser reads: scans fit it by \
             {:.2} on average, and by {:.2} if their readings are changed so; correct the \
             resolution in its YAML file from {resolution_m:.4} to about {right_m:.4}, or the \
             ranges of the laser",
            means[AS_MEASURED], means[best]
        ))
    })
}

/// Scale at the top of a gable through the best mean and its two neighbours.
fn top(means: &[f64; SCALES.len()], best: usize) -> f64 {
    let step = f64::from(SCALES[1] - SCALES[0]);
    let beside = best
        .checked_sub(1)
        .map(|i| means[i])
        .zip(means.get(best + 1));
    let steps = beside.map_or(0.0, |(below, &above)| {
        0.5 * (above - below) / (means[best] - above.min(below))
    });
    f64::from(SCALES[best]) + steps * step
}

/// Checks that the mount does not put the base into walls or off the map where the laser's pose is
/// known.
fn base_in_wall(located: &Located) -> Option<Finding> {
    let base = |found: &LocatedScan| {
        let mount = found.scan.base_from_laser.filter(|&mount| !is_far(mount));
        let mount = mount.filter(|_| found.is_unique)?;
        Some(found.map_from_laser.then(mount.inverse()))
    };
    let bases: Vec<Pose> = located.scans.iter().filter_map(base).collect();
    let is_free = |base: &&Pose| {
        let cell = located.map.cell_at(base.x, base.y);
        cell.is_some_and(|(x, y)| {
            let index = y as usize * located.map.width as usize + x as usize;
            !CellRules::default().is_occupied(located.map.cells[index])
        })
    };
    let bad = bases.len() - bases.iter().filter(is_free).count();
    let is_wrong = bases.len() >= MIN_SCANS && bad as f64 > MIN_SHARE * bases.len() as f64;
    is_wrong.then(|| {
        Finding::problem(format!(
            "by its mount, the base of the robot stands in a wall or off the map at {bad} of {} \
             places of the laser: correct the translation from base to laser",
            bases.len()
        ))
    })
}
