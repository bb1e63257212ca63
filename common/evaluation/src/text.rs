//! Formats numbers for tables; unknown values are a dash.

pub(crate) fn share(count: u64, of: u64) -> Option<f64> {
    (of > 0).then(|| count as f64 / of as f64)
}

/// Formats a share as per cent, with one decimal.
pub(crate) fn percent(share: Option<f64>) -> String {
    number(share.map(|share| 100.0 * share), 1)
}

/// Formats nanoseconds as seconds, exactly.
pub(crate) fn seconds(ns: i64) -> String {
    let second = 1_000_000_000;
    format!("{}.{:09}", ns.div_euclid(second), ns.rem_euclid(second))
}

pub(crate) fn number(value: Option<f64>, decimals: usize) -> String {
    value.map_or("-".to_owned(), |value| format!("{value:.decimals$}"))
}
