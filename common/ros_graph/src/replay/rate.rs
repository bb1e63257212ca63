//! Speed of a replay.

use std::fmt;
use std::str::FromStr;

/// Speed of a replay: a multiple of the original speed, or as fast as the graph answers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Rate {
    Factor(f64),
    /// The next scan follows the answer to the previous one.
    Max,
}

const ALLOWED: std::ops::RangeInclusive<f64> = 0.001..=1000.0;

impl FromStr for Rate {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match (text, text.parse()) {
            ("max", _) => Ok(Rate::Max),
            (_, Ok(factor)) if ALLOWED.contains(&factor) => Ok(Rate::Factor(factor)),
            _ => Err("allowed are 0.001 to 1000, and max".into()),
        }
    }
}

impl fmt::Display for Rate {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Rate::Factor(factor) => factor.fmt(f),
            Rate::Max => f.write_str("max"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn factors_within_their_range_and_max() {
        for text in ["0.001", "1", "2.5", "1000", "max"] {
            assert_eq!(text.parse::<Rate>().unwrap().to_string(), text);
        }
        for text in ["0", "-1", "1001", "inf", "nan", "fast", ""] {
            let error = text.parse::<Rate>().unwrap_err();
            assert_eq!(error, "allowed are 0.001 to 1000, and max", "{text}");
        }
    }
}
