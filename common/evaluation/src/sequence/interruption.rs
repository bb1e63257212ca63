//! A followed robot whose motion is unknown or wrong for one step: it is kidnapped, moved elsewhere
//! while its odometry reports no motion; or it drives on while no data arrives (an outage), and its
//! odometry starts again from there.

use engine::tracking::TrackingConfig;
use geometry::Pose;
use offline::World;

use super::drive::Moment;
use super::run::Run;

/// Distance for which the robot is followed before and after, in metres.
const BEFORE_M: f64 = 5.0;
const AFTER_M: f64 = 10.0;
/// Distance after which it should be right, in metres.
const RIGHT_AFTER_M: f64 = 5.0;

/// Shortest distance of a jump, in metres, and the number of scans that a tracker has to notice it.
const MIN_M: f64 = 3.0;
const TO_NOTICE: usize = 2;

/// Durations of the outages in turn, in seconds: a restarted driver, a failing network.
const SECONDS: [f64; 4] = [0.5, 1.0, 2.0, 4.0];

/// The last moment before, and the first one after.
#[derive(Debug, Clone, Copy)]
pub(super) struct Interruption {
    from: usize,
    to: usize,
    is_jump: bool,
}

#[derive(Debug, Default)]
pub(super) struct Interruptions {
    pub(super) count: u64,
    /// Jumps with a result other than Unique and wrong at one of the first two scans.
    pub(super) noticed: u64,
    /// Those that were right after 5 m.
    pub(super) right: u64,
    /// Those that were Unique and wrong, jumps from the third scan on: the scans before and after,
    /// and the largest error in metres.
    pub(super) wrong: Vec<(usize, usize, f64)>,
}

impl Interruptions {
    pub(super) fn merge(&mut self, other: &Self) {
        self.count += other.count;
        self.noticed += other.noticed;
        self.right += other.right;
        self.wrong.extend(&other.wrong);
    }
}

/// Chooses jumps, spread over the drive so that all differ.
pub(super) fn jumps(moments: &[Moment], count: u32) -> Vec<Interruption> {
    let truths: Vec<usize> = (0..moments.len())
        .filter(|&i| moments[i].truth.is_some())
        .collect();
    let total = moments.last().map_or(0.0, |last| last.gone_m);
    let at = |share: f64| truths.get((share * truths.len() as f64) as usize).copied();
    // Multiples of the golden ratio are spread evenly for any count.
    let golden = 0.618_033_988_749_895;
    (0..count * 4)
        .filter_map(|i| {
            let from = at((f64::from(i) + 0.5) / f64::from(count * 4))?;
            let to = at((f64::from(i) * golden + 0.25).fract())?;
            let (a, b) = (moments[from].truth?, moments[to].truth?);
            let is_fit = moments[from].gone_m >= BEFORE_M
                && total - moments[to].gone_m >= RIGHT_AFTER_M
                && a.distance_to(b) >= MIN_M;
            let is_jump = true;
            is_fit.then_some(Interruption { from, to, is_jump })
        })
        .step_by(2)
        .take(count as usize)
        .collect()
}

/// Chooses outages, spread over the drive.
pub(super) fn outages(moments: &[Moment], count: u32) -> Vec<Interruption> {
    let total = moments.last().map_or(0.0, |last| last.gone_m);
    let end = total - RIGHT_AFTER_M;
    let outage = |i: u32| {
        let at = BEFORE_M + (end - BEFORE_M) * (f64::from(i) + 0.5) / f64::from(count);
        let from = moments.partition_point(|moment| moment.gone_m < at);
        let ns = (SECONDS[i as usize % SECONDS.len()] * 1e9) as i64;
        let until_ns = moments.get(from)?.stamp_ns.saturating_add(ns);
        let to = moments.partition_point(|moment| moment.stamp_ns < until_ns);
        let is_fit = at > BEFORE_M && from < to && moments.get(to)?.gone_m <= end;
        let is_jump = false;
        is_fit.then_some(Interruption { from, to, is_jump })
    };
    (0..count).filter_map(outage).collect()
}

/// Follows the robot up to each interruption and on from there, without the scans in between. Those
/// at which it was not right before do not count.
pub(super) fn evaluate(
    world: &World,
    moments: &[Moment],
    chosen: &[Interruption],
    config: TrackingConfig,
) -> anyhow::Result<Interruptions> {
    let mut all = Interruptions::default();
    for &Interruption { from, to, is_jump } in chosen {
        let mut run = Run::new(world, moments, config);
        if !run.follow_to(from, BEFORE_M)? {
            continue;
        }
        let (mut said, mut is_right) = (Vec::new(), false);
        for (index, moment) in moments.iter().enumerate().skip(to) {
            let gone = moment.gone_m - moments[to].gone_m;
            if gone > AFTER_M {
                break;
            }
            let moved = match index == to {
                true => is_jump.then_some(Pose::IDENTITY),
                false => moment.moved,
            };
            let now = run.take(index, moved)?;
            if gone <= RIGHT_AFTER_M && now.off.is_some() {
                is_right = now.is_right();
            }
            said.push(now);
        }
        let to_notice = if is_jump { TO_NOTICE } else { 0 };
        let (first, rest) = said.split_at(said.len().min(to_notice));
        all.count += 1;
        all.noticed += u64::from(first.iter().any(|said| !said.is_wrong()));
        all.right += u64::from(is_right);
        let wrong = rest.iter().filter(|said| said.is_wrong());
        let wrong_m = wrong.filter_map(|said| Some(said.off?.0));
        if let Some(most) = wrong_m.reduce(f64::max) {
            all.wrong.push((from, to, most));
        }
    }
    Ok(all)
}
