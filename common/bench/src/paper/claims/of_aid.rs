//! Sections I and VI: the votes as an aid to Markov localization and particles.

use super::super::aid::Saved;
use super::{Basis, Case, Claim, least, most};

/// "Instead of across the entire terrain" is taken as a hundredth of it at most.
const FEW: f64 = 0.01;
/// Particles are fewer if there are at most half.
const FEWER_PARTICLES: f64 = 0.5;
/// As often is no less than this much of it: what a few dozen scans can distinguish.
const AS_OFTEN: f64 = 0.9;

const SECTION: &str = "I, VI";

/// The claims about help.
pub(in super::super) fn of_aid(all: &[Saved]) -> Vec<Claim> {
    let each = |of: fn(&Saved) -> f64| all.iter().map(of).collect::<Vec<f64>>();
    let poses = each(|saved| saved.poses.value);
    let particles = each(|saved| saved.particles.value);
    let mut claims = vec![
        at_most(
            "A1",
            "the votes say where belief computations need to be done",
            "the largest share of the poses that the votes leave",
            (Basis::Share, &poses, FEW),
        ),
        at_most(
            "A2",
            "the votes say where particles need to be initialized",
            "the largest share of the particles that are started there",
            (Basis::Share, &particles, FEWER_PARTICLES),
        ),
    ];
    claims.extend(successes(all));
    claims.extend(times(all));
    claims
}

fn successes(all: &[Saved]) -> [Claim; 2] {
    let ratio = |of: fn(&Saved) -> (f64, f64)| {
        let ratios = all.iter().map(of).map(|(with, without)| with / without);
        ratios.collect::<Vec<f64>>()
    };
    let markov = ratio(|s| (s.markov_helped.found.value, s.markov.found.value));
    let particles = ratio(|s| (s.monte_carlo_helped.found.value, s.monte_carlo.found.value));
    [
        at_least(
            "A3",
            "Markov localization finds the robot as often with that help",
            "the least ratio of successes, with over without",
            (Basis::Share, &markov, AS_OFTEN),
        ),
        at_least(
            "A4",
            "Monte Carlo localization finds the robot as often with that help",
            "the least ratio of successes, with over without",
            (Basis::Share, &particles, AS_OFTEN),
        ),
    ]
}

fn times(all: &[Saved]) -> [Claim; 2] {
    let ratio = |of: fn(&Saved) -> (f64, f64)| {
        let ratios = all.iter().map(of).map(|(with, without)| without / with);
        ratios.collect::<Vec<f64>>()
    };
    let markov = ratio(|s| (s.markov_helped.cpu_ms.value, s.markov.cpu_ms.value));
    let particles = ratio(|s| {
        (
            s.monte_carlo_helped.cpu_ms.value,
            s.monte_carlo.cpu_ms.value,
        )
    });
    [
        at_least(
            "A5",
            "the votes and Markov localization together are faster than it alone",
            "the least ratio of times, without over with",
            (Basis::Time, &markov, 1.0),
        ),
        at_least(
            "A6",
            "the votes and Monte Carlo localization together are faster than it alone",
            "the least ratio of times, without over with",
            (Basis::Time, &particles, 1.0),
        ),
    ]
}

type Bounded<'a> = (Basis, &'a [f64], f64);

fn at_least(
    id: &'static str,
    claim: &'static str,
    is: &'static str,
    (basis, values, bound): Bounded<'_>,
) -> Claim {
    Claim {
        id,
        section: SECTION,
        claim,
        paper: "no figure",
        basis,
        ours: least(values.iter().copied()),
        is,
        cases: values
            .iter()
            .map(|&value| Case::at_least(value, bound))
            .collect(),
    }
}

fn at_most(
    id: &'static str,
    claim: &'static str,
    is: &'static str,
    (basis, values, bound): Bounded<'_>,
) -> Claim {
    Claim {
        ours: most(values.iter().copied()),
        cases: values
            .iter()
            .map(|&value| Case::at_most(value, bound))
            .collect(),
        ..at_least(id, claim, is, (basis, values, bound))
    }
}
