//! Runs the tracker over a whole drive without an initial pose; writes trajectories and a picture.

use std::fmt::Write as _;
use std::path::Path;

use anyhow::Context;
use engine::tracking::TrackingConfig;
use geometry::Pose;
use offline::World;
use plots::Stop;

use super::drive::Moment;
use super::run::{Run, Said};
use crate::text::seconds;

/// Poses by stamp, in nanoseconds.
type Poses = [(i64, Pose)];

pub(super) const ENDINGS: [&str; 6] = [
    ".tum",
    "_truth.tum",
    ".csv",
    "_truth.csv",
    ".kitti",
    "_truth.kitti",
];

pub(super) fn of(
    world: &World,
    moments: &[Moment],
    config: TrackingConfig,
) -> anyhow::Result<Vec<Said>> {
    let mut run = Run::new(world, moments, config);
    let indices = 0..moments.len();
    indices.map(|i| run.take(i, moments[i].moved)).collect()
}

/// Writes the trajectories of the first laser: the tracker's, where believed, and the true one.
pub(super) fn write(
    folder: &Path,
    name: &str,
    (moments, said): (&[Moment], &[Said]),
) -> anyhow::Result<()> {
    let both = || moments.iter().zip(said);
    let tracked = both().filter(|(_, said)| said.report.state.is_believed());
    let tracked = tracked.filter_map(|(moment, said)| Some((moment.stamp_ns, said.pose?)));
    let truths = both().filter_map(|(moment, _)| Some((moment.stamp_ns, moment.truth?)));
    let [tracked, truths] = [tracked.collect::<Vec<_>>(), truths.collect()];
    let texts = files(&tracked, &truths, &pairs(moments, said));
    for (ending, text) in ENDINGS.iter().zip(texts) {
        let file = folder.join(format!("{name}{ending}"));
        std::fs::write(&file, text).with_context(|| format!("cannot write {}", file.display()))?;
    }
    Ok(())
}

/// Believed and true poses of the scans of which both are known.
pub(super) fn pairs(moments: &[Moment], said: &[Said]) -> Vec<(Pose, Pose)> {
    let both = moments.iter().zip(said);
    both.filter_map(|(moment, said)| {
        let pose = said.pose.filter(|_| said.report.state.is_believed());
        pose.zip(moment.truth)
    })
    .collect()
}

pub(super) fn stops(moments: &[Moment], said: &[Said]) -> Vec<Stop> {
    let both = moments.iter().zip(said);
    both.map(|(moment, said)| Stop {
        state: said.report.state,
        pose: said.pose,
        truth: moment.truth,
    })
    .collect()
}

/// Reasons for scans that were not Unique, with their counts, most frequent first.
pub(super) fn doubts(said: &[Said]) -> String {
    let mut counts: Vec<(String, u32)> = Vec::new();
    for said in said.iter().filter(|said| !said.is_unique()) {
        let reason = format!("{} ({:?})", said.report.state, said.report.reason);
        match counts.iter_mut().find(|(other, _)| *other == reason) {
            Some((_, count)) => *count += 1,
            None => counts.push((reason, 1)),
        }
    }
    counts.sort_by_key(|(_, count)| std::cmp::Reverse(*count));
    let words = counts
        .iter()
        .map(|(reason, count)| format!("{reason} {count}"));
    let words: Vec<String> = words.collect();
    match words.is_empty() {
        true => "Unique at every scan".into(),
        false => format!("scans that were not Unique: {}", words.join(", ")),
    }
}

/// Contents of [`ENDINGS`]. KITTI has no stamps, so its files hold the scans with both poses.
fn files(tracked: &Poses, truths: &Poses, pairs: &[(Pose, Pose)]) -> [String; 6] {
    [
        tum(tracked),
        tum(truths),
        csv(tracked),
        csv(truths),
        kitti(pairs.iter().map(|pair| pair.0)),
        kitti(pairs.iter().map(|pair| pair.1)),
    ]
}

/// One line per pose: seconds, x, y, z and a quaternion, in the TUM RGB-D format that evo reads.
fn tum(poses: &Poses) -> String {
    let mut lines = String::new();
    for &(stamp_ns, Pose { x, y, yaw }) in poses {
        let seconds = seconds(stamp_ns);
        let (sin, cos) = (0.5 * yaw).sin_cos();
        // Writing to a string cannot fail.
        let _ = writeln!(lines, "{seconds} {x} {y} 0 0 0 {sin} {cos}");
    }
    lines
}

fn csv(poses: &Poses) -> String {
    let mut lines = "stamp_ns,x_m,y_m,yaw_rad\n".to_owned();
    for (stamp_ns, Pose { x, y, yaw }) in poses {
        let _ = writeln!(lines, "{stamp_ns},{x},{y},{yaw}");
    }
    lines
}

/// One line per pose: the upper three rows of its matrix, row by row, as evo reads them.
fn kitti(poses: impl Iterator<Item = Pose>) -> String {
    let mut lines = String::new();
    for Pose { x, y, yaw } in poses {
        let (sin, cos) = yaw.sin_cos();
        let _ = writeln!(lines, "{cos} {} 0 {x} {sin} {cos} 0 {y} 0 0 1 0", -sin);
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_trajectory_has_a_line_a_scan() {
        let quarter = Pose::new(1.5, -2.0, std::f64::consts::FRAC_PI_2);
        let numbers = |line: &str, between: char| -> Vec<f64> {
            let words = line.trim_end().split(between);
            words.map(|word| word.parse().unwrap()).collect()
        };
        let poses = [(1_500_000_000, quarter)];
        let [tum, _, csv, none, kitti, _] = files(&poses, &[], &[(quarter, quarter)]);
        let half = 0.5f64.sqrt();
        let found = numbers(&tum, ' ');
        assert_eq!(found[..6], [1.5, 1.5, -2.0, 0.0, 0.0, 0.0]);
        // The tolerance covers the rounding of sine and cosine.
        assert!(found[6..].iter().all(|part| (part - half).abs() < 1e-15));
        assert_eq!(none, "stamp_ns,x_m,y_m,yaw_rad\n");
        let found = numbers(csv.lines().nth(1).unwrap(), ',');
        assert_eq!(found, [1.5e9, 1.5, -2.0, std::f64::consts::FRAC_PI_2]);
        let expected = [0.0, -1.0, 0.0, 1.5, 1.0, 0.0, 0.0, -2.0, 0.0, 0.0, 1.0, 0.0];
        let found = numbers(&kitti, ' ');
        let mut both = found.iter().zip(expected);
        let near = both.all(|(a, b)| (a - b).abs() < 1e-15);
        assert!(near && found.len() == 12, "{found:?}");
    }
}
