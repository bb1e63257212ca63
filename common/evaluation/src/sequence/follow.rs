//! Runs the tracker over a whole drive, starting at the truth.

use engine::tracking::TrackingConfig;
use offline::World;

use super::drive::Moment;
use super::run::{Run, Said, Tally};
use crate::text::share;

/// The robot counts as lost, and is put back to the truth, if it is off by more than this (metres,
/// degrees) for [`LOSS_TRUTHS`] truths in a row.
const LOSS: (f64, f64) = (1.0, 20.0);
const LOSS_TRUTHS: u32 = 3;

#[derive(Debug, Default)]
pub(super) struct Followed {
    /// Index and result of each moment after the first truth.
    pub(super) said: Vec<(usize, Said)>,
    pub(super) tally: Tally,
    /// Indices of the moments at which it was lost.
    pub(super) losses: Vec<usize>,
    sums: Sums,
    /// Number of times that Unique was given up although the pose was right.
    pub(super) false_alarms: u64,
    pub(super) hours: f64,
    pub(super) tracking_ms: Vec<f64>,
}

#[derive(Debug, Clone, Copy, Default)]
struct Sums {
    moments: u32,
    unique: u32,
    /// Moments with a truth at which it was not lost, and sums of their errors.
    truths: u32,
    squares_m: f64,
    squares_deg: f64,
    max_m: f64,
    /// Unique moments near the truth, and those of them whose 95 % ellipse contains it.
    unique_truths: u32,
    held: u32,
}

impl Followed {
    pub(super) fn rms_m(&self) -> Option<f64> {
        self.root_mean(self.sums.squares_m)
    }

    pub(super) fn rms_deg(&self) -> Option<f64> {
        self.root_mean(self.sums.squares_deg)
    }

    pub(super) fn max_m(&self) -> Option<f64> {
        (self.sums.truths > 0).then_some(self.sums.max_m)
    }

    /// Share of the Unique moments near the truth whose 95 % ellipse contains it.
    pub(super) fn in_ellipse(&self) -> Option<f64> {
        share(self.sums.held.into(), self.sums.unique_truths.into())
    }

    pub(super) fn unique_share(&self) -> Option<f64> {
        share(self.sums.unique.into(), self.sums.moments.into())
    }

    fn root_mean(&self, squares: f64) -> Option<f64> {
        let truths = self.sums.truths;
        (truths > 0).then(|| (squares / f64::from(truths)).sqrt())
    }

    /// Adds another drive, without its moments.
    pub(super) fn merge(&mut self, other: &Self) {
        self.tally = self.tally.with(&other.tally);
        self.losses.extend(&other.losses);
        self.false_alarms += other.false_alarms;
        self.hours += other.hours;
        self.tracking_ms.extend(&other.tracking_ms);
        let (all, more) = (&mut self.sums, &other.sums);
        all.moments += more.moments;
        all.unique += more.unique;
        all.truths += more.truths;
        all.squares_m += more.squares_m;
        all.squares_deg += more.squares_deg;
        all.max_m = all.max_m.max(more.max_m);
        all.unique_truths += more.unique_truths;
        all.held += more.held;
    }
}

/// Follows the drive. Without `puts_back` a lost robot must recover by itself, and is no loss.
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
    let (mut sums, mut was_right) = (Sums::default(), false);
    for &(index, said) in &all.said {
        sums.moments += 1;
        sums.unique += u32::from(said.is_unique());
        let Some((m, deg)) = said.off else { continue };
        if was_right && !said.is_unique() && m <= super::run::RIGHT.0 {
            all.false_alarms += 1;
        }
        was_right = said.is_right();
        if m <= LOSS.0 && deg <= LOSS.1 {
            sums.truths += 1;
            sums.squares_m += m * m;
            sums.squares_deg += deg * deg;
            sums.max_m = sums.max_m.max(m);
        }
        if said.is_unique() && !said.is_off() {
            sums.unique_truths += 1;
            sums.held += u32::from(is_in_ellipse(&moments[index], &said));
        }
    }
    all.sums = sums;
}

fn is_in_ellipse(moment: &Moment, said: &Said) -> bool {
    let Some(((target, laser), truth)) = said.report.pose.zip(said.pose).zip(moment.truth) else {
        return false;
    };
    let covariance = said.report.covariance.carried(target, laser);
    answers::statistics::holds(covariance, laser, truth)
}
