//! Parsers for numbers in options; their errors name the allowed values.

use std::ops::RangeInclusive;

/// Parses N numbers separated by commas.
pub(crate) fn numbers<const N: usize>(text: &str) -> Option<[f64; N]> {
    let parsed = text.split(',').map(|word| word.trim().parse().ok());
    parsed.collect::<Option<Vec<f64>>>()?.try_into().ok()
}

/// Checks that a number is within a range; NaN never is.
pub(crate) fn within(value: f64, allowed: RangeInclusive<f64>, unit: &str) -> Result<f64, String> {
    let (low, high) = (allowed.start(), allowed.end());
    match allowed.contains(&value) {
        true => Ok(value),
        false => Err(format!("{value} is not within {low} to {high} {unit}")),
    }
}

/// Parses a number within a range.
pub(crate) fn parse(text: &str, allowed: RangeInclusive<f64>, unit: &str) -> Result<f64, String> {
    let value = text
        .parse()
        .map_err(|_| format!("{text:?} is not a number"))?;
    within(value, allowed, unit)
}

/// Parses a share, 0..=1.
pub(crate) fn parse_share(text: &str) -> Result<f64, String> {
    parse(text, 0.0..=1.0, "as a share")
}
