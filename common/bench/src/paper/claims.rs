//! The claims of the paper and what was measured of them: one row each, with a verdict.
//! Pure.

mod of_aid;
mod of_corridor;
mod of_counts;
mod of_sonar;
mod of_tables;

use super::folder::{Csv, digits};
pub(super) use of_aid::of_aid;
pub(super) use of_corridor::of_corridor;
pub(super) use of_counts::of_counts;
pub(super) use of_sonar::of_sonar;
pub(super) use of_tables::{of_table_1, of_table_2};

/// What a claim is judged by. Counts, shares and errors come out the same on every
/// machine, as far as it rounds alike; times do not.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Basis {
    Count,
    Share,
    Error,
    Time,
}

/// A figure that was measured, and what the claim asks of it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Case {
    value: f64,
    bound: f64,
    is_met: bool,
}

/// A claim.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Claim {
    /// As `docs/paper.md` names it.
    pub(super) id: &'static str,
    pub(super) section: &'static str,
    pub(super) claim: &'static str,
    /// What the paper prints.
    pub(super) paper: &'static str,
    pub(super) basis: Basis,
    /// Our figure, and what it is.
    pub(super) ours: f64,
    pub(super) is: &'static str,
    pub(super) cases: Vec<Case>,
}

impl Case {
    pub(super) fn at_most(value: f64, bound: f64) -> Self {
        Case {
            value,
            bound,
            is_met: value <= bound,
        }
    }

    pub(super) fn at_least(value: f64, bound: f64) -> Self {
        Case {
            value,
            bound,
            is_met: value >= bound,
        }
    }

    /// Comparable: within a factor of two.
    pub(super) fn about(value: f64, bound: f64) -> Self {
        Case {
            value,
            bound: if value > bound {
                2.0 * bound
            } else {
                bound / 2.0
            },
            is_met: (0.5..=2.0).contains(&(value / bound)),
        }
    }

    /// The factor by which the value would have to change to be judged otherwise.
    fn margin(self) -> f64 {
        let ratio = self.value / self.bound;
        ratio.max(1.0 / ratio)
    }
}

impl Claim {
    fn met(&self) -> usize {
        self.cases.iter().filter(|case| case.is_met).count()
    }

    fn verdict(&self) -> &'static str {
        match self.met() {
            0 => "does not hold",
            met if met == self.cases.len() => "holds",
            _ => "in part",
        }
    }

    /// That of the case that is nearest to its bound.
    fn margin(&self) -> f64 {
        let margins = self.cases.iter().map(|case| case.margin());
        margins.fold(f64::INFINITY, f64::min)
    }
}

/// A row for each claim.
pub(super) fn csv(claims: &[Claim]) -> Csv {
    let mut csv = Csv::new(&[
        "id",
        "section",
        "claim",
        "paper",
        "basis",
        "ours",
        "is",
        "cases_met",
        "cases",
        "margin",
        "verdict",
    ]);
    for claim in claims {
        let basis = match claim.basis {
            Basis::Count => "count",
            Basis::Share => "share",
            Basis::Error => "error",
            Basis::Time => "time",
        };
        let texts = [claim.id, claim.section, claim.claim, claim.paper, basis];
        let mut row: Vec<String> = texts.map(str::to_owned).to_vec();
        row.extend([digits(claim.ours), claim.is.to_owned()]);
        row.extend([claim.met(), claim.cases.len()].map(|count| count.to_string()));
        row.extend([digits(claim.margin()), claim.verdict().to_owned()]);
        csv.push(row);
    }
    csv
}

/// The largest of some values.
fn most(values: impl Iterator<Item = f64>) -> f64 {
    values.fold(f64::NEG_INFINITY, f64::max)
}

/// The least of some values.
fn least(values: impl Iterator<Item = f64>) -> f64 {
    values.fold(f64::INFINITY, f64::min)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_claim_holds_in_part_where_some_cases_do() {
        let claim = |cases: Vec<Case>| Claim {
            id: "X",
            section: "II",
            claim: "",
            paper: "",
            basis: Basis::Time,
            ours: 1.0,
            is: "",
            cases,
        };
        let (met, missed) = (Case::at_least(3.0, 2.0), Case::at_most(3.0, 2.0));
        assert_eq!(claim(vec![met]).verdict(), "holds");
        assert_eq!(claim(vec![missed]).verdict(), "does not hold");
        assert_eq!(claim(vec![met, missed]).verdict(), "in part");
        assert_eq!(claim(vec![met, Case::about(1.0, 1.0)]).margin(), 1.5);
        assert!(!Case::about(2.1, 1.0).is_met && Case::about(0.6, 1.0).is_met);
    }
}
