//! Figures as the pages show them, made of JSON; a value that is missing is a dash. Pure.

use serde_json::Value;

/// Placeholder for a missing figure.
pub(super) const NONE: &str = "–";

fn shown(value: &Value, format: impl FnOnce(f64) -> String) -> String {
    value.as_f64().map_or(NONE.to_owned(), format)
}

pub(super) fn number(value: &Value) -> String {
    value.as_u64().map_or(NONE.to_owned(), |n| n.to_string())
}

/// Number with a comma between thousands.
pub(super) fn thousands(number: u64) -> String {
    match number {
        0..1000 => number.to_string(),
        _ => format!("{},{:03}", thousands(number / 1000), number % 1000),
    }
}

/// Whole per cent.
pub(super) fn percent(share: &Value) -> String {
    shown(share, |share| format!("{:.0}", 100.0 * share))
}

/// Per cent with a digit behind the point, unless all.
pub(super) fn share(share: &Value) -> String {
    let percent = |share| format!("{:.1} %", 100.0 * share).replace("100.0", "100");
    shown(share, percent)
}

/// Per cent of one count in another.
pub(super) fn share_of(part: &Value, all: &Value) -> String {
    match (part.as_f64(), all.as_f64()) {
        (Some(part), Some(all)) => share(&(part / all).into()),
        _ => NONE.to_owned(),
    }
}

pub(super) fn turn(degrees: &Value) -> String {
    shown(degrees, |degrees| format!("{degrees:.2}°"))
}

pub(super) fn metres(metres: &Value) -> String {
    shown(metres, |metres| format!("{metres:.3}"))
}

pub(super) fn centimetres(metres: &Value) -> String {
    shown(metres, |metres| format!("{:.1} cm", 100.0 * metres))
}

/// Median and 90th percentile, in whole milliseconds.
pub(super) fn milliseconds(spread: &Value) -> String {
    let whole = |value| shown(value, |ms| format!("{ms:.0}"));
    format!(
        "{} / {} ms",
        whole(&spread["median"]),
        whole(&spread["p90"])
    )
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    #[test]
    fn figures_are_rounded_and_missing_ones_are_dashes() {
        assert_eq!(share(&json!(0.9996)), "100 %");
        assert_eq!(share(&json!(0.8636)), "86.4 %");
        assert_eq!(share_of(&json!(1), &json!(8)), "12.5 %");
        assert_eq!(percent(&json!(0.815)), "82");
        assert_eq!(turn(&json!(0.0449)), "0.04°");
        assert_eq!(centimetres(&json!(0.0094)), "0.9 cm");
        assert_eq!(thousands(1_002_003), "1,002,003");
        assert_eq!(thousands(7), "7");
        assert_eq!(
            milliseconds(&json!({"median": 4.6, "p90": 5.2})),
            "5 / 5 ms"
        );
        let missing = &json!({})["none"];
        assert_eq!((number(missing), share(missing)), ("–".into(), "–".into()));
    }
}
