//! Tables 1 and 2, and what section II says of correlation.

use super::super::super::method::Method;
use super::super::printed::NOISE;
use super::super::tables::{COMMON_NOISE, Measured};
use super::{Basis, Case, Claim, least, most};

/// A table that was measured.
#[derive(Clone, Copy)]
struct Table<'a>(&'a [Measured]);

impl Table<'_> {
    fn at(&self, method: Method, p_over_n: u32, noise: u32) -> Option<&Measured> {
        self.0.iter().find(|row| {
            row.method == method.name() && row.p_over_n == p_over_n && row.noise == noise
        })
    }

    /// Its time over the scatter's.
    fn ratio(&self, method: Method, p_over_n: u32, noise: u32) -> f64 {
        self.at(method, p_over_n, noise)
            .map_or(f64::NAN, |row| row.ratio.value)
    }

    fn ms(&self, method: Method, p_over_n: u32, noise: u32) -> f64 {
        self.at(method, p_over_n, noise)
            .map_or(f64::NAN, |row| row.cpu_ms.value)
    }

    /// Ratios at all noises of table 1.
    fn ratios(&self, method: Method, p_over_n: &[u32]) -> Vec<f64> {
        p_over_n
            .iter()
            .flat_map(|&p| NOISE.map(|noise| self.ratio(method, p, noise)))
            .collect()
    }
}

/// A claim about times; ours is the first of the values, or what `ours` makes of them.
struct Timed {
    id: &'static str,
    section: &'static str,
    claim: &'static str,
    paper: &'static str,
    is: &'static str,
}

impl Timed {
    fn of(self, ours: f64, cases: Vec<Case>) -> Claim {
        Claim {
            id: self.id,
            section: self.section,
            claim: self.claim,
            paper: self.paper,
            basis: Basis::Time,
            ours,
            is: self.is,
            cases,
        }
    }

    /// All values reach a bound.
    fn at_least(self, values: &[f64], bound: f64) -> Claim {
        let cases = values.iter().map(|&value| Case::at_least(value, bound));
        self.of(least(values.iter().copied()), cases.collect())
    }

    /// No value exceeds a bound.
    fn at_most(self, values: &[f64], bound: f64) -> Claim {
        let cases = values.iter().map(|&value| Case::at_most(value, bound));
        self.of(most(values.iter().copied()), cases.collect())
    }

    /// All are about as large as a bound.
    fn about(self, values: &[f64], bound: f64) -> Claim {
        let cases = values.iter().map(|&value| Case::about(value, bound));
        let far = |value: f64| (value / bound).ln().abs();
        let farthest = values
            .iter()
            .copied()
            .max_by(|a, b| far(*a).total_cmp(&far(*b)));
        self.of(farthest.unwrap_or(f64::NAN), cases.collect())
    }
}

const IV: &str = "IV, Table 1";

/// The claims about table 1.
pub(in super::super) fn of_table_1(rows: &[Measured]) -> Vec<Claim> {
    let table = Table(rows);
    let mut claims = correlation(table);
    claims.extend(at_low_ratios(table));
    claims.extend(at_high_ratios(table));
    let ours: Vec<f64> = table.ratios(Method::Sweep, &[10, 25, 50, 100, 120]);
    let gains: Vec<f64> = ours.iter().map(|ratio| 1.0 / ratio).collect();
    claims.push(
        Timed {
            id: "E9",
            section: IV,
            claim: "ours: the sweep is faster than the paper's method as written",
            paper: "-",
            is: "the least ratio of times, scatter over sweep",
        }
        .at_least(&gains, 1.0),
    );
    claims
}

/// Section II: correlation is faster than Markov localization and less accurate.
fn correlation(table: Table<'_>) -> Vec<Claim> {
    let ratio = |p: u32| {
        table.ratio(Method::RayCasting, p, COMMON_NOISE)
            / table.ratio(Method::Patch, p, COMMON_NOISE)
    };
    let speed: Vec<f64> = [10, 25, 50, 100, 120].map(ratio).to_vec();
    let found = |method: Method| {
        let rows = table.0.iter().filter(|row| row.method == method.name());
        let shares: Vec<f64> = rows.map(|row| row.found).collect();
        shares.iter().sum::<f64>() / shares.len() as f64
    };
    let accuracy = found(Method::Patch) / found(Method::RayCasting);
    vec![
        Timed {
            id: "L1",
            section: "II",
            claim: "correlation is faster than Markov localization",
            paper: "faster",
            is: "the least ratio of times, Markov over correlation",
        }
        .at_least(&speed, 1.0),
        Claim {
            id: "L2",
            section: "II",
            claim: "correlation is less accurate than Markov localization, as it has no visibility",
            paper: "not accurate as",
            basis: Basis::Share,
            ours: accuracy,
            is: "its successes over those of Markov localization",
            cases: vec![Case::at_most(accuracy, 1.0)],
        },
    ]
}

fn at_low_ratios(table: Table<'_>) -> Vec<Claim> {
    let time = |method, p, noise| table.ms(method, p, noise);
    let growth = time(Method::Scatter, 10, 25) / time(Method::Scatter, 10, 5);
    let fall =
        time(Method::RayCasting, 120, COMMON_NOISE) / time(Method::RayCasting, 10, COMMON_NOISE);
    let rise = time(Method::Scatter, 120, COMMON_NOISE) / time(Method::Scatter, 10, COMMON_NOISE);
    vec![
        Timed {
            id: "E1",
            section: IV,
            claim: "at low p/n at least 25 times faster than Markov localization",
            paper: "25 (its table: 26-29)",
            is: "the least ratio at p/n 10 %",
        }
        .at_least(&table.ratios(Method::RayCasting, &[10]), 25.0),
        Timed {
            id: "E2",
            section: IV,
            claim: "at low p/n 8 times faster than correlation",
            paper: "8 (its table: 3.2-10)",
            is: "the least ratio at p/n 10 %",
        }
        .at_least(&table.ratios(Method::Patch, &[10]), 8.0),
        Timed {
            id: "E3",
            section: IV,
            claim: "at low p/n the time hardly grows with k",
            paper: "1.11 times from 5 to 25 % noise",
            is: "time at 25 % noise over that at 5 %, p/n 10 %",
        }
        .at_most(&[growth], 1.25),
        Timed {
            id: "E4",
            section: IV,
            claim: "as p/n rises the time of Markov localization falls",
            paper: "0.16 times from 10 to 120 %",
            is: "time at p/n 120 % over that at 10 %",
        }
        .at_most(&[fall], 1.0),
        Timed {
            id: "E5",
            section: IV,
            claim: "as p/n rises the time of reverse projection rises",
            paper: "1.7 times from 10 to 120 %",
            is: "time at p/n 120 % over that at 10 %",
        }
        .at_least(&[rise], 1.0),
    ]
}

fn at_high_ratios(table: Table<'_>) -> Vec<Claim> {
    let time = |noise| table.ms(Method::Scatter, 120, noise);
    vec![
        Timed {
            id: "E6",
            section: IV,
            claim: "at p/n of 100 % and more 2.5 times faster than Markov localization",
            paper: "2.5 (its table: 2.6-3.7)",
            is: "the least ratio at p/n 100 and 120 %",
        }
        .at_least(&table.ratios(Method::RayCasting, &[100, 120]), 2.5),
        Timed {
            id: "E7",
            section: IV,
            claim: "at p/n 100 % 1.2 to 1.4 times faster than correlation, at 120 % comparable",
            paper: "1.2-1.4 (its table: 1.1-1.25), 1.0",
            is: "the ratio farthest from 1",
        }
        .about(&table.ratios(Method::Patch, &[100, 120]), 1.0),
        Timed {
            id: "E8",
            section: IV,
            claim: "at high p/n k has practically no effect on the time",
            paper: "1.02 times from 5 to 25 % noise",
            is: "time at 25 % noise over that at 5 %, p/n 120 %",
        }
        .at_most(&[time(25) / time(5)], 1.25),
    ]
}

const TABLE_2: &str = "IV, Table 2";

/// The claims about table 2.
pub(in super::super) fn of_table_2(rows: &[Measured]) -> Vec<Claim> {
    let table = Table(rows);
    let ratio = |method, p| table.ratio(method, p, COMMON_NOISE);
    let all = [10, 25, 50, 100, 120];
    let particles = all.map(|p| ratio(Method::MonteCarlo, p) / ratio(Method::RayCasting, p));
    let gains = all.map(|p| 1.0 / ratio(Method::Search, p));
    let past = all.map(|p| ratio(Method::RayCasting, p) / ratio(Method::Search, p));
    let timed = |id, claim, paper, is| Timed {
        id,
        section: TABLE_2,
        claim,
        paper,
        is,
    };
    vec![
        timed(
            "F1",
            "with the heading, at low p/n significantly faster than Markov localization",
            "4.1",
            "the ratio at p/n 10 %",
        )
        .at_least(&[ratio(Method::RayCasting, 10)], 4.1),
        timed(
            "F2",
            "with the heading, at high p/n 1.2 times faster than Markov localization",
            "1.2 (its table: 1.1-1.3)",
            "the least ratio at p/n 100 and 120 %",
        )
        .at_least(&[100, 120].map(|p| ratio(Method::RayCasting, p)), 1.2),
        timed(
            "F3",
            "with the heading, at high p/n comparable to correlation",
            "1.0-1.2",
            "the ratio farthest from 1 at p/n 100 and 120 %",
        )
        .about(&[100, 120].map(|p| ratio(Method::Patch, p)), 1.0),
        timed(
            "F4",
            "Monte Carlo localization takes about as long as Markov localization",
            "almost same",
            "the ratio of times farthest from 1, Monte Carlo over Markov",
        )
        .about(&particles, 1.0),
        timed(
            "F5",
            "ours: the search is faster than the paper's method as written",
            "-",
            "the least ratio of times, scatter over search",
        )
        .at_least(&gains, 1.0),
        timed(
            "F6",
            "ours: the search is faster than Markov localization",
            "-",
            "the least ratio of times, Markov over search",
        )
        .at_least(&past, 1.0),
    ]
}
