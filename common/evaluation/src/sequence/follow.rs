//! Runs the tracker over a whole drive, starting at the truth.

use engine::tracking::TrackingConfig;
use offline::World;

use super::drive::Moment;
use super::run::{RIGHT, Run, Said, Tally};
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
    /// Number of times that Unique was given up although the pose was right.
    pub(super) false_alarms: u64,
    pub(super) hours: f64,
    pub(super) tracking_ms: Vec<f64>,
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
    /// True if the last moment with a truth was Unique and right.
    was_right: bool,
}

impl Followed {
    pub(super) fn rms_m(&self) -> Option<f64> {
        self.root_mean(self.squares_m)
    }

    pub(super) fn rms_deg(&self) -> Option<f64> {
        self.root_mean(self.squares_deg)
    }

    pub(super) fn max_m(&self) -> Option<f64> {
        (self.truths > 0).then_some(self.max_m)
    }

    /// Share of the Unique moments near the truth whose 95 % ellipse contains it.
    pub(super) fn in_ellipse(&self) -> Option<f64> {
        share(self.held.into(), self.unique_truths.into())
    }

    pub(super) fn unique_share(&self) -> Option<f64> {
        share(self.unique.into(), self.moments.into())
    }

    fn root_mean(&self, squares: f64) -> Option<f64> {
        (self.truths > 0).then(|| (squares / f64::from(self.truths)).sqrt())
    }

    fn add(&mut self, moment: &Moment, said: &Said) {
        self.tally.add(moment, said);
        self.moments += 1;
        self.unique += u32::from(said.is_unique());
        let Some((m, deg)) = said.off else { return };
        let is_given_up = self.was_right && !said.is_unique() && m <= RIGHT.0;
        self.false_alarms += u64::from(is_given_up);
        self.was_right = said.is_right();
        if m <= LOSS.0 && deg <= LOSS.1 {
            self.truths += 1;
            self.squares_m += m * m;
            self.squares_deg += deg * deg;
            self.max_m = self.max_m.max(m);
        }
        if said.is_unique() && !said.is_off() {
            self.unique_truths += 1;
            self.held += u32::from(is_in_ellipse(moment, said));
        }
    }

    /// Adds another drive, without its moments.
    pub(super) fn merge(&mut self, other: &Self) {
        self.tally = self.tally.with(&other.tally);
        self.losses.extend(&other.losses);
        self.false_alarms += other.false_alarms;
        self.hours += other.hours;
        self.tracking_ms.extend(&other.tracking_ms);
        self.moments += other.moments;
        self.unique += other.unique;
        self.truths += other.truths;
        self.squares_m += other.squares_m;
        self.squares_deg += other.squares_deg;
        self.max_m = self.max_m.max(other.max_m);
        self.unique_truths += other.unique_truths;
        self.held += other.held;
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
        all.add(moment, &said);
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
    Ok(all)
}

fn is_in_ellipse(moment: &Moment, said: &Said) -> bool {
    let Some(((target, laser), truth)) = said.report.pose.zip(said.pose).zip(moment.truth) else {
        return false;
    };
    let covariance = said.report.covariance.carried(target, laser);
    answers::statistics::holds(covariance, laser, truth)
}
