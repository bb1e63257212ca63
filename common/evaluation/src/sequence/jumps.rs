//! Kidnapped robot: a followed robot is moved elsewhere while its odometry reports no motion.

use engine::tracking::TrackingConfig;
use geometry::Pose;
use offline::World;

use super::drive::Moment;
use super::interruption::{Aftermath, BEFORE_M, Interruption, RIGHT_AFTER_M};
use super::run::Said;

/// Shortest distance of a jump, in metres.
const MIN_M: f64 = 3.0;

/// Results of all jumps.
#[derive(Debug, Default)]
pub(super) struct Jumps {
    pub(super) jumps: u64,
    /// Jumps with a result other than Unique and wrong at one of the first two scans.
    pub(super) noticed: u64,
    /// Jumps that were right after 5 m.
    pub(super) right: u64,
    /// Jumps, from and to, that were Unique and wrong from the third scan on.
    pub(super) wrong: Vec<(usize, usize)>,
}

impl Jumps {
    /// Adds the jumps of another drive.
    pub(super) fn merge(&mut self, other: &Self) {
        self.jumps += other.jumps;
        self.noticed += other.noticed;
        self.right += other.right;
        self.wrong.extend(&other.wrong);
    }
}

/// Chooses pairs of moments, from and to, spread over the drive so that all jumps differ.
pub(super) fn choose(moments: &[Moment], count: u32) -> Vec<(usize, usize)> {
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
            is_fit.then_some((from, to))
        })
        .step_by(2)
        .take(count as usize)
        .collect()
}

pub(super) fn evaluate(
    world: &World,
    moments: &[Moment],
    chosen: &[(usize, usize)],
    config: TrackingConfig,
) -> anyhow::Result<Jumps> {
    let mut all = Jumps::default();
    for &(from, to) in chosen {
        let jump = Interruption {
            from,
            to,
            moved: Some(Pose::IDENTITY),
        };
        let Some(Aftermath { said, is_right }) = jump.evaluate(world, moments, config)? else {
            continue;
        };
        let (first, rest) = said.split_at(said.len().min(2));
        all.jumps += 1;
        all.noticed += u64::from(first.iter().any(|said| !said.is_wrong()));
        all.right += u64::from(is_right);
        if rest.iter().any(Said::is_wrong) {
            all.wrong.push((from, to));
        }
    }
    Ok(all)
}
