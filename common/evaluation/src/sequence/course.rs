//! Runs the tracker over a whole drive without an initial pose; writes trajectories and a picture.

use std::path::Path;

use anyhow::Context;
use engine::tracking::TrackingConfig;
use geometry::Pose;
use offline::World;
use plots::Stop;

use super::drive::Moment;
use super::run::{Run, Said};
use super::trajectory;

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
    let texts = trajectory::files(&tracked, &truths, &pairs(moments, said));
    for (ending, text) in trajectory::ENDINGS.iter().zip(texts) {
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
