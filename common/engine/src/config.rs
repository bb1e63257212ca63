//! Parsers of settings; their errors name the value and the allowed range.

use std::ops::RangeInclusive;

/// Parses a length of 0 to 2 metres: the width of a taper, the arc of a beam.
#[cfg(feature = "clap")]
pub(crate) fn parse_length(text: &str) -> Result<f64, String> {
    parse(text, 0.0..=2.0, "metres")
}

/// Parses a share of 0 to 1.
#[cfg(feature = "clap")]
pub(crate) fn parse_share(text: &str) -> Result<f64, String> {
    parse(text, 0.0..=1.0, "as a share")
}

/// Parses an angle of 0 to 180 degrees.
#[cfg(feature = "clap")]
pub(crate) fn parse_degrees(text: &str) -> Result<f64, String> {
    parse(text, 0.0..=180.0, "degrees")
}

/// Returns a parser of numbers within a range.
#[cfg(feature = "clap")]
pub(crate) fn within(
    allowed: RangeInclusive<f64>,
    unit: &'static str,
) -> impl Fn(&str) -> Result<f64, String> + Clone + Send + Sync {
    move |text| parse(text, allowed.clone(), unit)
}

/// Parses a number within a range.
pub(crate) fn parse(text: &str, allowed: RangeInclusive<f64>, unit: &str) -> Result<f64, String> {
    let value: f64 = text
        .parse()
        .map_err(|_| format!("{text:?} is not a number"))?;
    if allowed.contains(&value) {
        return Ok(value);
    }
    let (from, to) = (allowed.start(), allowed.end());
    Err(format!("{value} is not within {from} to {to} {unit}"))
}

#[cfg(test)]
#[cfg(feature = "clap")]
mod tests {
    use super::*;

    #[test]
    fn values_out_of_range_are_refused_by_name() {
        assert_eq!(parse_length("0.2"), Ok(0.2));
        assert_eq!(
            parse_length("-1"),
            Err("-1 is not within 0 to 2 metres".into())
        );
        assert_eq!(
            parse_share("NaN"),
            Err("NaN is not within 0 to 1 as a share".into())
        );
        assert_eq!(parse_share("x"), Err("\"x\" is not a number".into()));
    }
}
