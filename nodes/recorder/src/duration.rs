//! Durations in the form that users type.

use std::time::Duration;

/// Longest duration allowed: a year.
const LONGEST_S: f64 = 365.0 * 86_400.0;

/// Parses `90`, `90s`, `10m` or `1.5h`; a bare number is in seconds.
pub(crate) fn parse(text: &str) -> Result<Duration, String> {
    let unit = |suffix, seconds| text.strip_suffix(suffix).map(|number| (number, seconds));
    let (number, seconds) = unit('s', 1.0)
        .or_else(|| unit('m', 60.0))
        .or_else(|| unit('h', 3600.0))
        .unwrap_or((text, 1.0));
    match number.parse::<f64>() {
        Ok(number) if number > 0.0 && number * seconds <= LONGEST_S => {
            Ok(Duration::from_secs_f64(number * seconds))
        }
        _ => Err("allowed are times above 0 up to a year, as 90s, 10m or 1.5h".into()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_are_seconds_minutes_and_hours() {
        for (text, seconds) in [
            ("90", 90.0),
            ("0.5s", 0.5),
            ("10m", 600.0),
            ("1.5h", 5400.0),
        ] {
            assert_eq!(parse(text).unwrap(), Duration::from_secs_f64(seconds));
        }
        for text in ["", "0", "-1s", "m", "10d", "nan", "inf", "1e9h"] {
            assert!(parse(text).unwrap_err().contains("as 90s, 10m"), "{text}");
        }
    }
}
