//! Runs the tracker over the whole drive from its first scan, without an initial pose, and writes
//! trajectories and a picture.

use std::fmt::Write as _;
use std::path::Path;

use anyhow::Context;
use engine::tracking::TrackingConfig;
use geometry::Pose;
use offline::World;
use plots::Stop;

use super::drive::Moment;
use super::errors::Errors;
use super::run::{Run, Said};

/// Results of the tracker for each moment.
///
/// # Errors
/// The CPU clock cannot be read.
pub(super) fn of(
    world: &World,
    moments: &[Moment],
    config: TrackingConfig,
) -> anyhow::Result<Vec<Said>> {
    let mut run = Run::new(world, moments, config);
    let indices = 0..moments.len();
    indices.map(|i| run.take(i, moments[i].moved)).collect()
}

/// Writes two trajectories of the first laser: the tracker's, for scans where it was Unique or
/// Doubtful, and the true one. One line per scan: seconds, x, y, z and a quaternion, in the TUM
/// RGB-D format that evo reads.
///
/// # Errors
/// A file cannot be written.
pub(super) fn write(
    folder: &Path,
    name: &str,
    (moments, said): (&[Moment], &[Said]),
) -> anyhow::Result<()> {
    let both = || moments.iter().zip(said);
    let tracked = both().filter(|(_, said)| said.report.state.is_believed());
    let tracked = tracked.filter_map(|(moment, said)| Some((moment.stamp_ns, said.pose?)));
    let truths = both().filter_map(|(moment, _)| Some((moment.stamp_ns, moment.truth?)));
    let save = |file: String, lines: String| {
        let file = folder.join(file);
        std::fs::write(&file, lines).with_context(|| format!("cannot write {}", file.display()))
    };
    save(format!("{name}.tum"), trajectory(tracked))?;
    save(format!("{name}_truth.tum"), trajectory(truths))
}

/// Errors of the tracked poses that [`write`] writes.
pub(super) fn errors(moments: &[Moment], said: &[Said]) -> Errors {
    let both = moments.iter().zip(said);
    let pairs = both.filter_map(|(moment, said)| {
        let pose = said.pose.filter(|_| said.report.state.is_believed());
        pose.zip(moment.truth)
    });
    Errors::of(&pairs.collect::<Vec<_>>())
}

fn trajectory(poses: impl Iterator<Item = (i64, Pose)>) -> String {
    let mut lines = String::new();
    for (stamp_ns, Pose { x, y, yaw }) in poses {
        let (seconds, rest) = (
            stamp_ns.div_euclid(1_000_000_000),
            stamp_ns.rem_euclid(1_000_000_000),
        );
        let (sin, cos) = (0.5 * yaw).sin_cos();
        // Writing to a string cannot fail.
        let _ = writeln!(lines, "{seconds}.{rest:09} {x} {y} 0 0 0 {sin} {cos}");
    }
    lines
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_trajectory_has_a_line_a_scan() {
        let quarter = Pose::new(1.5, -2.0, std::f64::consts::PI);
        let lines = trajectory([(1_500_000_000, quarter)].into_iter());
        let words: Vec<f64> = lines
            .split_whitespace()
            .map(|w| w.parse().unwrap())
            .collect();
        assert_eq!(words[..7], [1.5, 1.5, -2.0, 0.0, 0.0, 0.0, 1.0]);
        assert!(words[7].abs() < 1e-15 && lines.ends_with('\n'));
    }
}
