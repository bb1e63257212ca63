//! Starts the tracker at many scans of a drive, without an initial pose.

use std::collections::BTreeMap;

use engine::tracking::{MIN_BEAMS, TrackingConfig};
use offline::World;
use schemars::JsonSchema;
use serde::{Serialize, Serializer};

use super::drive::Moment;
use super::run::{Run, Said, Tally};
use crate::text::share;

/// Distances at which a start is judged, in metres.
pub(super) const AFTER_M: [f64; 5] = [1.0, 2.0, 5.0, 10.0, 20.0];

/// Tolerance in metres of the end of a drive before a distance: the last scan may be a step short.
const STEP_M: f64 = 1.2;

/// Starts keep this distance from the end of the drive: the smaller of metres and share.
const LEFT: (f64, f64) = (5.0, 0.3);

#[derive(Debug, Default)]
pub(super) struct Starts {
    pub(super) starts: u64,
    /// Counts for each distance of [`AFTER_M`]: judged, right, and not yet Unique.
    pub(super) judged: [u64; 5],
    pub(super) right: [u64; 5],
    pub(super) not_yet: [u64; 5],
    /// Starts with a Unique and wrong pose at any time: the scan of the start, the scan of the
    /// first such pose, and its error in metres.
    pub(super) wrong: Vec<(usize, usize, f64)>,
    pub(super) tally: Tally,
    pub(super) scans: u64,
    pub(super) searches: u64,
}

impl Starts {
    pub(super) fn merge(&mut self, other: &Self) {
        self.starts += other.starts;
        for i in 0..AFTER_M.len() {
            self.judged[i] += other.judged[i];
            self.right[i] += other.right[i];
            self.not_yet[i] += other.not_yet[i];
        }
        self.wrong.extend(&other.wrong);
        self.tally = self.tally.with(&other.tally);
        self.scans += other.scans;
        self.searches += other.searches;
    }
}

/// Shares of the starts, by metres after the start.
#[derive(Debug, Clone, PartialEq, JsonSchema)]
pub(super) struct After(
    #[schemars(with = "BTreeMap<String, Option<f64>>")] pub(super) Vec<(f64, Option<f64>)>,
);

impl After {
    /// Shares of the judged starts, for the distances of [`AFTER_M`].
    pub(super) fn of(parts: &[u64; 5], judged: &[u64; 5]) -> Self {
        let shares = parts.iter().zip(judged).map(|(&part, &of)| share(part, of));
        After(AFTER_M.into_iter().zip(shares).collect())
    }
}

impl Serialize for After {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_map(self.0.iter().map(|(m, share)| (m.to_string(), share)))
    }
}

/// Chooses scans with a truth as starts, evenly spaced along the drive.
pub(super) fn choose(moments: &[Moment], count: u32) -> Vec<usize> {
    let total = moments.last().map_or(0.0, |last| last.gone_m);
    let end = total - LEFT.0.min(LEFT.1 * total);
    let is_fit = |moment: &Moment| moment.truth.is_some() && moment.ends().beams() >= MIN_BEAMS;
    let mut chosen: Vec<usize> = (0..count)
        .filter_map(|i| {
            let at = end * f64::from(i) / f64::from(count.max(2) - 1);
            let from = moments.partition_point(|moment| moment.gone_m < at - 1e-9);
            (from..moments.len()).find(|&index| is_fit(&moments[index]))
        })
        .collect();
    chosen.dedup();
    chosen
}

pub(super) fn evaluate(
    world: &World,
    moments: &[Moment],
    chosen: &[usize],
    config: TrackingConfig,
) -> anyhow::Result<Starts> {
    let mut all = Starts::default();
    for &start in chosen {
        all.starts += 1;
        let mut run = Run::new(world, moments, config);
        let farthest = AFTER_M[AFTER_M.len() - 1];
        let mut last: [Option<Said>; 5] = [None; 5];
        let (mut gone, mut is_wrong) = (0.0, false);
        for index in start..moments.len() {
            gone = moments[index].gone_m - moments[start].gone_m;
            if gone > farthest + 1e-9 {
                break;
            }
            let moved = moments[index].moved.filter(|_| index > start);
            let said = run.take(index, moved)?;
            all.tally.add(&moments[index], &said);
            if said.is_wrong() && !is_wrong {
                is_wrong = true;
                all.wrong
                    .push((start, index, said.off.map_or(0.0, |(m, _)| m)));
            }
            if said.off.is_none() {
                continue;
            }
            for (after, last) in AFTER_M.iter().zip(&mut last) {
                if gone <= after + 1e-9 {
                    *last = Some(said);
                }
            }
        }
        for (i, after) in AFTER_M.iter().enumerate() {
            if gone < after - STEP_M {
                continue;
            }
            all.judged[i] += 1;
            let said = last[i];
            all.right[i] += u64::from(said.is_some_and(|said| said.is_right()));
            all.not_yet[i] += u64::from(said.is_none_or(|said| !said.is_unique()));
        }
        all.scans += run.tracking_ms.len() as u64 + run.searches;
        all.searches += run.searches;
    }
    Ok(all)
}
