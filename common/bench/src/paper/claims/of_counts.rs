//! Sections II B and III: operations and additions.

use super::super::counts::Counted;
use super::{Basis, Case, Claim, most};

fn operations(counted: &Counted) -> f64 {
    counted.reverse.operations() as f64 / counted.markov.operations() as f64
}

fn of_worst(counted: &Counted) -> f64 {
    counted.reverse.additions as f64 / counted.reverse.worst_additions as f64
}

fn of_mn(counted: &Counted) -> f64 {
    counted.reverse.additions as f64 / counted.mn() as f64
}

/// A value for each p/n.
fn each(all: &[Counted], of: impl Fn(&Counted) -> f64) -> Vec<f64> {
    all.iter().map(of).collect()
}

/// A claim that no value exceeds 1; ours is the largest.
fn at_most_one(mut claim: Claim, values: &[f64]) -> Claim {
    claim.ours = most(values.iter().copied());
    let cases = values.iter().map(|&value| Case::at_most(value, 1.0));
    claim.cases = cases.collect();
    claim
}

fn blank(id: &'static str, section: &'static str) -> Claim {
    Claim {
        id,
        section,
        claim: "",
        paper: "",
        basis: Basis::Count,
        ours: f64::NAN,
        is: "",
        cases: Vec::new(),
    }
}

/// The claims about counts.
pub(in super::super) fn of_counts(all: &[Counted]) -> Vec<Claim> {
    let few = || {
        all.iter()
            .filter(|c| c.p < c.n)
            .copied()
            .collect::<Vec<_>>()
    };
    let many = || {
        all.iter()
            .filter(|c| c.p > c.n)
            .copied()
            .collect::<Vec<_>>()
    };
    let mut claims = formulas(all);
    claims.extend([
        at_most_one(
            Claim {
                claim: "fewer operations than Markov localization where p < n",
                paper: "2mp < 2mn",
                is: "the largest share of Markov's operations, p < n",
                ..blank("C4", "II B")
            },
            &each(&few(), operations),
        ),
        at_most_one(
            Claim {
                claim: "no more operations than Markov localization where p > n",
                paper: "less than or equal",
                is: "the largest share of Markov's operations, p > n",
                ..blank("C5", "II B")
            },
            &each(&many(), operations),
        ),
        at_most_one(
            Claim {
                claim: "obstacles leave fewer than k cells to be updated, and none of some readings",
                paper: "less than k",
                is: "the largest share of the readings projected back that reach their cells",
                ..blank("C6", "II B")
            },
            &each(all, |c| c.reverse.projections as f64 / c.mp() as f64),
        ),
        at_most_one(
            Claim {
                claim: "Lemma 1: no more than m intersections in a free cell",
                paper: "m",
                is: "the largest number of beams in a cell over m",
                ..blank("T3", "III")
            },
            &each(all, |c| f64::from(c.most_votes) / Counted::M as f64),
        ),
        at_most_one(
            Claim {
                claim: "Theorem 1: no more than mn computations, whatever p is",
                paper: "mn",
                is: "the largest share of mn additions",
                ..blank("T4", "III")
            },
            &each(all, of_mn),
        ),
    ]);
    claims
}

/// Counts against what the paper calculates.
fn formulas(all: &[Counted]) -> Vec<Claim> {
    let exact = each(all, |c| {
        c.markov.operations() as f64 / c.markov_formula() as f64
    });
    let additions = each(all, |c| c.markov.additions as f64 / (2 * c.mn()) as f64);
    let both = exact.iter().chain(&additions);
    let markov = Claim {
        claim: "Markov localization takes n(2m+1) operations and 2mn additions",
        paper: "n(2m+1), 2mn",
        is: "counted over calculated",
        ours: most(both.clone().copied()),
        cases: both
            .flat_map(|&value| [Case::at_most(value, 1.0), Case::at_least(value, 1.0)])
            .collect(),
        ..blank("C1", "II B")
    };
    let operations = at_most_one(
        Claim {
            claim: "reverse projection takes 2mp operations at worst",
            paper: "2mp",
            is: "the largest share of 2mp",
            ..blank("C2", "II B")
        },
        &each(all, |c| c.reverse.operations() as f64 / (2 * c.mp()) as f64),
    );
    let additions = at_most_one(
        Claim {
            claim: "reverse projection takes kmp additions at worst",
            paper: "kmp",
            is: "the largest share of kmp",
            ..blank("C3", "II B")
        },
        &each(all, of_worst),
    );
    vec![markov, operations, additions]
}
