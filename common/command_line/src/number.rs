//! Parsers for numbers in options; their errors name the allowed values.

use std::ops::RangeInclusive;

/// Returns a parser for numbers within a range, for `value_parser` of clap.
pub fn number(
    allowed: RangeInclusive<f64>,
    unit: &'static str,
) -> impl Fn(&str) -> Result<f64, String> + Clone + Send + Sync + 'static {
    move |text| {
        let value = text
            .parse()
            .map_err(|_| format!("{text:?} is not a number"));
        within(value?, &allowed, unit)
    }
}

/// Returns a message with value and range if `value` is outside or NaN.
pub fn within(value: f64, allowed: &RangeInclusive<f64>, unit: &str) -> Result<f64, String> {
    let (low, high) = (allowed.start(), allowed.end());
    match allowed.contains(&value) {
        true => Ok(value),
        false => Err(format!("{value} is not within {low} to {high} {unit}")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_out_of_range_are_refused_by_name() {
        let metres = number(0.0..=2.0, "metres");
        assert_eq!(metres("0.2"), Ok(0.2));
        let refused = |text| metres(text).unwrap_err();
        assert_eq!(refused("-1"), "-1 is not within 0 to 2 metres");
        assert_eq!(refused("NaN"), "NaN is not within 0 to 2 metres");
        assert_eq!(refused("x"), "\"x\" is not a number");
    }
}
