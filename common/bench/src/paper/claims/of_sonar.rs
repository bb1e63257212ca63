//! Sections II A and IV: eight sonars.

use engine::taper::TaperShape;

use super::super::sonar::Judged;
use super::{Basis, Case, Claim, least, most};

/// A share that is no worse than another is at least this much of it: what a hundred poses
/// can distinguish.
const AS_GOOD: f64 = 0.95;
/// The peak is taken for the robot if it is in this many of the poses.
const RELIABLE: f64 = 0.95;
/// The paper's error of a position, per cent.
const MAX_PERCENT: f64 = 5.0;

/// The claims about eight sonars.
pub(in super::super) fn of_sonar(all: &[Judged]) -> Vec<Claim> {
    let is_plain = |judged: &&Judged| {
        let variant = judged.variant;
        variant.taper == TaperShape::Gaussian
            && (variant.true_sigma_deg, variant.sigma_deg) == (0.0, 0.0)
    };
    let plain = || all.iter().filter(is_plain);
    let papers = || plain().filter(|judged| judged.variant.noise_percent <= 5);
    let errors = || papers().map(|judged| judged.mean_percent.value);
    let found_errors = || papers().map(|judged| judged.found_mean_percent.value);
    let found = || papers().map(|judged| judged.found.value);
    vec![
        tapers(all),
        bearings(all),
        Claim {
            id: "S1",
            section: "IV",
            claim: "the position error is 3 to 5 % on average for measurement errors of 3 to 5 %, over all poses",
            paper: "3-5 %",
            basis: Basis::Error,
            ours: most(errors()),
            is: "the largest mean error, % of the mean reading",
            cases: errors()
                .map(|percent| Case::at_most(percent, MAX_PERCENT))
                .collect(),
        },
        Claim {
            id: "S2",
            section: "IV",
            claim: "the same, over the poses where the peak is within 0.5 m",
            paper: "3-5 %",
            basis: Basis::Error,
            ours: most(found_errors()),
            is: "the largest mean error of those found, % of the mean reading",
            cases: found_errors()
                .map(|percent| Case::at_most(percent, MAX_PERCENT))
                .collect(),
        },
        Claim {
            id: "S3",
            section: "IV",
            claim: "the region of highest intensity is where the robot is",
            paper: "in both maps",
            basis: Basis::Share,
            ours: least(found()),
            is: "the least share of poses with the peak within 0.5 m",
            cases: found()
                .map(|share| Case::at_least(share, RELIABLE))
                .collect(),
        },
    ]
}

/// Shares of poses found with one variant over those with another, in each map.
fn ratios(
    all: &[Judged],
    is_tried: impl Fn(&Judged) -> bool,
    is_base: impl Fn(&Judged) -> bool,
) -> Vec<f64> {
    let tried = all.iter().filter(|judged| is_tried(judged));
    let ratio = |judged: &Judged| {
        let mut bases = all.iter().filter(|other| is_base(other));
        let base = bases.find(|other| {
            other.place == judged.place
                && other.variant.noise_percent == judged.variant.noise_percent
        });
        base.map(|base| judged.found.value / base.found.value)
    };
    tried.filter_map(ratio).collect()
}

fn tapers(all: &[Judged]) -> Claim {
    let no_bearing =
        |judged: &Judged| judged.variant.true_sigma_deg + judged.variant.sigma_deg == 0.0;
    let ratios = ratios(
        all,
        |judged| judged.variant.taper != TaperShape::Gaussian,
        |judged| judged.variant.taper == TaperShape::Gaussian && no_bearing(judged),
    );
    Claim {
        id: "M1",
        section: "II A",
        claim: "a Gaussian is not required: any taper suffices",
        paper: "suffices",
        basis: Basis::Share,
        ours: least(ratios.iter().copied()),
        is: "the least share of the Gaussian's successes, of three other tapers",
        cases: ratios
            .into_iter()
            .map(|ratio| Case::at_least(ratio, AS_GOOD))
            .collect(),
    }
}

fn bearings(all: &[Judged]) -> Claim {
    let at = |sigma: f64| {
        move |judged: &Judged| {
            (judged.variant.true_sigma_deg, judged.variant.sigma_deg) == (1.0, sigma)
        }
    };
    let ratios = ratios(all, at(0.0), at(1.0));
    Claim {
        id: "M2",
        section: "II A",
        claim: "σ_θ can be neglected: the quality is not affected",
        paper: "not affected",
        basis: Basis::Share,
        ours: least(ratios.iter().copied()),
        is: "the least share of the successes with σ_θ, bearings erring by 1°",
        cases: ratios
            .into_iter()
            .map(|ratio| Case::at_least(ratio, AS_GOOD))
            .collect(),
    }
}
