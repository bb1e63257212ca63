//! Shares of an axis for values, and the round numbers written along it. Pure.

#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Scale {
    /// Evenly from the first value to the second.
    Even(f64, f64),
    /// By their logarithms; both are above 0.
    Decades(f64, f64),
}

/// An even scale ends at a multiple of a round step, of which there are at most this many.
const STEPS: f64 = 12.0;

/// Beyond the last value this share of it is left free.
const HEADROOM: f64 = 0.03;

impl Scale {
    /// An even scale over all values, from 0 on.
    pub(super) fn from_zero(values: impl Iterator<Item = f64>) -> Self {
        let high = values.filter(|value| value.is_finite()).fold(0.0, f64::max);
        let high = high * (1.0 + HEADROOM);
        let step = round_step(high.max(f64::MIN_POSITIVE) / STEPS);
        Scale::Even(0.0, (high / step).ceil().max(1.0) * step)
    }

    /// A scale of decades that holds all values above 0, to the next 1, 2 or 5.
    pub(super) fn of_decades(values: impl Iterator<Item = f64>) -> Self {
        let above = values.filter(|&value| value.is_finite() && value > 0.0);
        let (low, high) = above.fold((f64::INFINITY, 0.0_f64), |(low, high), value| {
            (low.min(value), high.max(value))
        });
        if low > high {
            return Scale::Decades(1.0, 10.0);
        }
        let below = 1.0 / round_step(1.0 / low);
        Scale::Decades(below, round_step(high).max(2.0 * below))
    }

    /// Share of the axis up to a value, clamped to 0..=1.
    pub(super) fn share(self, value: f64) -> f64 {
        let share = match self {
            Scale::Even(low, high) => (value - low) / (high - low),
            Scale::Decades(low, high) => (value / low).ln() / (high / low).ln(),
        };
        if share.is_nan() {
            return 0.0;
        }
        share.clamp(0.0, 1.0)
    }

    /// Whether a value lies before the axis' beginning.
    pub(super) fn is_below(self, value: f64) -> bool {
        match self {
            Scale::Even(low, _) => value < low,
            // Powers of ten are not exact below 1.
            Scale::Decades(low, _) => value < low * (1.0 - 1e-9),
        }
    }

    /// Values that are written along the axis, with their text: about `most`.
    pub(super) fn ticks(self, most: u32) -> Vec<(f64, String)> {
        let values: Vec<f64> = match self {
            Scale::Even(low, high) => {
                let step = round_step((high - low) / f64::from(most));
                // Ends that are round are met but for their rounding.
                let first = (low / step - 1e-9).ceil() as i64;
                let last = (high / step + 1e-9).floor() as i64;
                (first..=last).map(|i| i as f64 * step).collect()
            }
            Scale::Decades(low, high) => decades(low, high, most),
        };
        values.into_iter().map(|it| (it, number(it))).collect()
    }
}

/// 1, 2 and 5 of each decade where these are few, else powers of ten or each second one.
fn decades(low: f64, high: f64, most: u32) -> Vec<f64> {
    // Powers of ten are not exact below 1.
    let within = low * (1.0 - 1e-9)..=high * (1.0 + 1e-9);
    let powers = || low.log10().floor() as i32..=high.log10().ceil() as i32;
    let choices: [(&[f64], i32); 5] = [
        (&[1.0, 2.0, 5.0], 1),
        (&[1.0], 1),
        (&[1.0], 2),
        (&[1.0], 3),
        (&[1.0], 6),
    ];
    let mut values = Vec::new();
    for (factors, every) in choices {
        let some = powers().filter(|power| power % every == 0);
        let all = some.flat_map(|power| factors.iter().map(move |f| f * 10f64.powi(power)));
        values = all.filter(|value| within.contains(value)).collect();
        if values.len() <= most as usize + 3 {
            break;
        }
    }
    values
}

/// The least of 1, 2, 5, 10 and so on that is not below a length above 0.
pub(super) fn round_step(length: f64) -> f64 {
    let power = 10f64.powf(length.log10().floor());
    let factors = [1.0, 2.0, 5.0];
    let fits = factors.into_iter().find(|factor| factor * power >= length);
    fits.unwrap_or(10.0) * power
}

/// A round number without an exponent, up to a millionth.
pub(super) fn number(value: f64) -> String {
    let text = format!("{value:.6}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    match text {
        "-0" | "" => "0".to_owned(),
        text => text.replace('-', "−"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn texts(scale: Scale) -> Vec<String> {
        scale.ticks(7).into_iter().map(|(_, text)| text).collect()
    }

    #[test]
    fn ticks_are_round_and_within_the_axis() {
        let expected = ["0", "20", "40", "60", "80", "100", "120"];
        assert_eq!(texts(Scale::Even(0.0, 120.0)), expected);
        let found = texts(Scale::Even(-0.3, 0.3));
        assert_eq!(found, ["−0.3", "−0.2", "−0.1", "0", "0.1", "0.2", "0.3"]);
        let found = texts(Scale::Decades(0.5, 20.0));
        assert_eq!(found, ["0.5", "1", "2", "5", "10", "20"]);
        let found = texts(Scale::Decades(0.01, 100.0));
        assert_eq!(found, ["0.01", "0.1", "1", "10", "100"]);
        let few = Scale::Decades(0.001, 1000.0).ticks(3);
        let values: Vec<f64> = few.into_iter().map(|(value, _)| value).collect();
        assert_eq!(values, [0.01, 1.0, 100.0]);
    }

    #[test]
    fn axes_hold_their_values() {
        let expected = Scale::Even(0.0, 100.0);
        assert_eq!(Scale::from_zero([3.0, 97.0].into_iter()), expected);
        let Scale::Decades(low, high) = Scale::of_decades([0.3, 0.0, 41.0].into_iter()) else {
            panic!("another scale");
        };
        // Roots and powers of ten round.
        assert!(
            (low - 0.2).abs() < 1e-9 && (high - 50.0).abs() < 1e-9,
            "{low} {high}"
        );
        let found = Scale::of_decades(std::iter::empty());
        assert_eq!(found, Scale::Decades(1.0, 10.0));
    }

    #[test]
    fn shares_run_along_the_axis_and_end_at_its_ends() {
        let scale = Scale::Decades(1.0, 100.0);
        assert_eq!(scale.share(10.0), 0.5);
        assert_eq!((scale.share(0.0), scale.share(1e9)), (0.0, 1.0));
        assert_eq!(Scale::Even(2.0, 4.0).share(3.0), 0.5);
        assert!(!scale.is_below(1.0) && scale.is_below(0.9) && scale.is_below(0.0));
    }
}
