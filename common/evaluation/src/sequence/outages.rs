//! Outages: a followed robot drives on while no data arrives, and its odometry starts again from
//! there.

use engine::tracking::TrackingConfig;
use offline::World;

use super::drive::Moment;
use super::interruption::{Aftermath, BEFORE_M, Interruption, RIGHT_AFTER_M};

/// Durations of the outages in turn, in seconds: a restarted driver, a failing network.
const SECONDS: [f64; 4] = [0.5, 1.0, 2.0, 4.0];

/// Results of all outages.
#[derive(Debug, Default)]
pub(super) struct Outages {
    pub(super) outages: u64,
    /// Outages that were right after 5 m.
    pub(super) right: u64,
    /// Unique and wrong outages: the last scan before, the first after, and the largest error in
    /// metres.
    pub(super) wrong: Vec<(usize, usize, f64)>,
}

impl Outages {
    /// Adds the outages of another drive.
    pub(super) fn merge(&mut self, other: &Self) {
        self.outages += other.outages;
        self.right += other.right;
        self.wrong.extend(&other.wrong);
    }
}

/// Chooses the last scan before and the first after each outage, spread over the drive.
pub(super) fn choose(moments: &[Moment], count: u32) -> Vec<(usize, usize)> {
    let total = moments.last().map_or(0.0, |last| last.gone_m);
    let end = total - RIGHT_AFTER_M;
    let outage = |i: u32| {
        let at = BEFORE_M + (end - BEFORE_M) * (f64::from(i) + 0.5) / f64::from(count);
        let from = moments.partition_point(|moment| moment.gone_m < at);
        let ns = (SECONDS[i as usize % SECONDS.len()] * 1e9) as i64;
        let until_ns = moments.get(from)?.stamp_ns.saturating_add(ns);
        let to = moments.partition_point(|moment| moment.stamp_ns < until_ns);
        let is_fit = at > BEFORE_M && from < to && moments.get(to)?.gone_m <= end;
        is_fit.then_some((from, to))
    };
    (0..count).filter_map(outage).collect()
}

/// Evaluates the chosen outages, leaving out the scans in between.
pub(super) fn evaluate(
    world: &World,
    moments: &[Moment],
    chosen: &[(usize, usize)],
    config: TrackingConfig,
) -> anyhow::Result<Outages> {
    let mut all = Outages::default();
    for &(from, to) in chosen {
        let outage = Interruption {
            from,
            to,
            moved: None,
        };
        let Some(Aftermath { said, is_right }) = outage.evaluate(world, moments, config)? else {
            continue;
        };
        all.outages += 1;
        all.right += u64::from(is_right);
        let wrong = said.iter().filter(|said| said.is_wrong());
        let wrong_m = wrong.filter_map(|said| Some(said.off?.0));
        if let Some(most) = wrong_m.reduce(f64::max) {
            all.wrong.push((from, to, most));
        }
    }
    Ok(all)
}
