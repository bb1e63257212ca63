//! Runs the tracker over a whole drive, starting at the truth.

use engine::tracking::TrackingConfig;
use geometry::Covariance;
use offline::World;

use super::drive::Moment;
use super::run::{Run, Said, Tally};

/// The robot counts as lost, and is put back to the truth, if it is off by more than this (metres,
/// degrees) for [`LOSS_TRUTHS`] truths in a row.
const LOSS: (f64, f64) = (1.0, 20.0);
const LOSS_TRUTHS: u32 = 3;

/// Results of following a drive.
#[derive(Debug, Default)]
pub(super) struct Followed {
    /// Index and result of each moment after the first truth.
    pub(super) said: Vec<(usize, Said)>,
    pub(super) tally: Tally,
    /// Indices of the moments at which it was lost.
    pub(super) losses: Vec<usize>,
    pub(super) rms_m: Option<f64>,
    pub(super) rms_deg: Option<f64>,
    pub(super) max_m: Option<f64>,
    /// Share of the Unique moments near the truth whose 95 % ellipse contains it.
    pub(super) in_ellipse: Option<f64>,
    pub(super) unique_share: Option<f64>,
    /// Number of times that Unique was given up although the pose was right.
    pub(super) false_alarms: u64,
    pub(super) hours: f64,
    pub(super) tracking_ms: Vec<f64>,
}

/// Follows the drive. With `puts_back` a lost robot is put back to the truth; otherwise it must
/// recover by itself, and no loss is counted.
pub(super) fn evaluate(
    world: &World,
    moments: &[Moment],
    config: TrackingConfig,
    puts_back: bool,
) -> anyhow::Result<Followed> {
    let mut all = Followed::default();
    let first = moments.iter().position(|moment| moment.truth.is_some());
    let Some((first, truth)) = first.and_then(|i| Some((i, moments[i].truth?))) else {
        return Ok(all);
    };
    let mut run = Run::new(world, moments, config);
    run.start_at(first, truth);
    let mut off_for = 0;
    for (index, moment) in moments.iter().enumerate().skip(first + 1) {
        let said = run.take(index, moment.moved)?;
        let is_lost = said.off.map(|(m, deg)| m > LOSS.0 || deg > LOSS.1);
        off_for = match is_lost {
            Some(true) => off_for + 1,
            Some(false) => 0,
            None => off_for,
        };
        all.tally.add(moment, &said);
        all.said.push((index, said));
        if puts_back
            && off_for == LOSS_TRUTHS
            && let Some(truth) = moment.truth
        {
            all.losses.push(index);
            run.start_at(index, truth);
            off_for = 0;
        }
    }
    all.hours = moments.last().map_or(0.0, |last| {
        (last.stamp_ns - moments[first].stamp_ns) as f64 / 3.6e12
    });
    all.tracking_ms = run.tracking_ms;
    sum_up(&mut all, moments);
    Ok(all)
}

fn sum_up(all: &mut Followed, moments: &[Moment]) {
    let (mut truths, mut squares, mut turns, mut max_m) = (0u32, 0.0, 0.0, 0.0f64);
    let (mut unique, mut unique_truths, mut held, mut was_right) = (0u32, 0u32, 0u32, false);
    for &(index, said) in &all.said {
        unique += u32::from(said.is_unique());
        let Some((m, deg)) = said.off else { continue };
        if was_right && !said.is_unique() && m <= super::run::RIGHT.0 {
            all.false_alarms += 1;
        }
        was_right = said.is_right();
        if m <= LOSS.0 && deg <= LOSS.1 {
            truths += 1;
            squares += m * m;
            turns += deg * deg;
            max_m = max_m.max(m);
        }
        if said.is_unique() && !said.is_off() {
            unique_truths += 1;
            held += u32::from(is_in_ellipse(&moments[index], &said));
        }
    }
    if truths > 0 {
        all.rms_m = Some((squares / f64::from(truths)).sqrt());
        all.rms_deg = Some((turns / f64::from(truths)).sqrt());
        all.max_m = Some(max_m);
    }
    let share = |part: u32, of: u32| (of > 0).then(|| f64::from(part) / f64::from(of));
    all.in_ellipse = share(held, unique_truths);
    all.unique_share = share(unique, all.said.len() as u32);
}

/// True if the true position is inside the 95 % ellipse.
fn is_in_ellipse(moment: &Moment, said: &Said) -> bool {
    let Some(((target, laser), truth)) = said.report.pose.zip(said.pose).zip(moment.truth) else {
        return false;
    };
    let covariance = Covariance(said.report.covariance).carried(target, laser);
    statistics::holds(covariance, laser, truth)
}
