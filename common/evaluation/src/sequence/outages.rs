//! Outages: a robot that is followed drives on while nothing of it is heard, and counts its
//! odometry from there.

use engine::tracking::FollowConfig;
use offline::World;

use super::drive::Moment;
use super::run::Run;
use crate::EvaluationError;

/// How long nothing is heard, in turn, seconds: a restarted driver, a network that fails.
const SECONDS: [f64; 4] = [0.5, 1.0, 2.0, 4.0];

/// The robot is followed for this many metres before, and for this many after.
const BEFORE_M: f64 = 5.0;
const AFTER_M: f64 = 10.0;
const RIGHT_AFTER_M: f64 = 5.0;

/// How robots fared that were not heard for a while.
#[derive(Debug, Default)]
pub(super) struct Outages {
    pub(super) outages: u64,
    /// Right after 5 m.
    pub(super) right: u64,
    /// Unique and wrong: the last scan before, the first after, and by how many metres at
    /// most.
    pub(super) wrong: Vec<(usize, usize, f64)>,
}

/// The last scan before each and the first one after: spread over the drive.
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

/// Leaves out what lies between these scans.
pub(super) fn evaluate(
    world: &World,
    moments: &[Moment],
    chosen: &[(usize, usize)],
    config: FollowConfig,
) -> Result<Outages, EvaluationError> {
    let mut all = Outages::default();
    for &(from, to) in chosen {
        let mut run = Run::new(world, moments, config);
        if !run.follow_to(from, BEFORE_M)? {
            continue;
        }
        all.outages += 1;
        let (mut wrong_m, mut is_right) = (0.0f64, false);
        for index in to..moments.len() {
            let gone = moments[index].gone_m - moments[to].gone_m;
            if gone > AFTER_M {
                break;
            }
            let moved = moments[index].moved.filter(|_| index > to);
            let said = run.take(index, moved)?;
            if said.is_wrong() {
                wrong_m = wrong_m.max(said.off.map_or(0.0, |(m, _)| m));
            }
            if gone <= RIGHT_AFTER_M && said.off.is_some() {
                is_right = said.is_right();
            }
        }
        all.right += u64::from(is_right);
        if wrong_m > 0.0 {
            all.wrong.push((from, to, wrong_m));
        }
    }
    Ok(all)
}
