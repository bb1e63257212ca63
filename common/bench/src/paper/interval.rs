//! Figures with the interval that holds the true one with a probability of 95 %. Pure.

use plots::CurvePoint;

use super::folder::digits;

#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Interval {
    pub(super) value: f64,
    pub(super) low: f64,
    pub(super) high: f64,
}

impl Interval {
    pub(super) fn at(self, x: f64) -> CurvePoint {
        CurvePoint {
            x,
            y: self.value,
            interval: Some((self.low, self.high)),
        }
    }

    pub(super) fn fields(self) -> [String; 3] {
        [self.value, self.low, self.high].map(digits)
    }
}

/// Student's t at 97.5 % for 1, 2, 3 … degrees of freedom.
const STUDENT: [f64; 20] = [
    12.706, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306, 2.262, 2.228, 2.201, 2.179, 2.160,
    2.145, 2.131, 2.120, 2.110, 2.101, 2.093, 2.086,
];
/// The normal distribution's at 97.5 %.
const NORMAL: f64 = 1.960;

/// The mean of normal values; without any all is NaN, of one alone the interval is it.
pub(super) fn of_mean(values: &[f64]) -> Interval {
    let count = values.len() as f64;
    let mean = values.iter().sum::<f64>() / count;
    let squares = values.iter().map(|it| (it - mean).powi(2)).sum::<f64>();
    let half = match values.len() {
        0 | 1 => 0.0,
        n => {
            let student = STUDENT.get(n - 2).copied().unwrap_or(NORMAL);
            student * (squares / (count - 1.0) / count).sqrt()
        }
    };
    Interval {
        value: mean,
        low: mean - half,
        high: mean + half,
    }
}

/// The mean of values that are never below 0.
pub(super) fn of_errors(values: &[f64]) -> Interval {
    let mean = of_mean(values);
    Interval {
        low: mean.low.max(0.0),
        ..mean
    }
}

/// The geometric mean of ratios or times above 0, whose logarithms are taken as normal.
pub(super) fn of_ratio(ratios: &[f64]) -> Interval {
    let logs: Vec<f64> = ratios.iter().map(|ratio| ratio.ln()).collect();
    let Interval { value, low, high } = of_mean(&logs);
    Interval {
        value: value.exp(),
        low: low.exp(),
        high: high.exp(),
    }
}

/// A share of `count` trials (Wilson's interval); without any all is NaN.
pub(super) fn of_share(successes: usize, count: usize) -> Interval {
    let (n, share) = (count as f64, successes as f64 / count as f64);
    let square = NORMAL * NORMAL;
    let middle = (share + square / (2.0 * n)) / (1.0 + square / n);
    let half =
        NORMAL / (1.0 + square / n) * (share * (1.0 - share) / n + square / (4.0 * n * n)).sqrt();
    Interval {
        value: share,
        low: (middle - half).max(0.0),
        high: (middle + half).min(1.0),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_mean_has_the_interval_of_student() {
        let Interval { value, low, high } = of_mean(&[1.0, 2.0, 3.0]);
        // The deviation is 1, of the mean 1/√3; t is 4.303.
        assert_eq!(value, 2.0);
        assert!((high - 2.0 - 4.303 / 3f64.sqrt()).abs() < 1e-9);
        assert!((low + high - 4.0).abs() < 1e-9);
        assert_eq!(of_mean(&[5.0]).high, 5.0);
        assert!(of_mean(&[]).value.is_nan());
        assert_eq!(of_errors(&[0.0, 9.0]).low, 0.0);
    }

    #[test]
    fn ratios_are_averaged_by_their_logarithms() {
        let Interval { value, .. } = of_ratio(&[2.0, 8.0]);
        assert!((value - 4.0).abs() < 1e-9);
    }

    #[test]
    fn a_share_of_all_is_not_sure() {
        let Interval { value, low, high } = of_share(20, 20);
        // Wilson: n / (n + 1.96²).
        assert!((low - 20.0 / (20.0 + 3.8416)).abs() < 1e-9, "{low}");
        assert_eq!((value, high), (1.0, 1.0));
    }
}
