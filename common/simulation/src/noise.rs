//! Errors of individual readings.

use std::str::FromStr;

use command_line::within;
use rand::RngExt;
use rand::rngs::Xoshiro256PlusPlus;
use rand_distr::{Distribution, StandardNormal};

use crate::numbers::numbers;

/// Readings are rounded to millimetres, as on real devices.
const STEPS_PER_METRE: f64 = 1000.0;

/// Normal errors that grow with the range.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Noise {
    /// Standard deviation at zero range, metres, 0..=2.
    pub sigma_m: f64,
    /// Increase per metre of range, 0..=0.25.
    pub sigma_per_m: f64,
}

impl FromStr for Noise {
    type Err = String;

    /// Parses `METRES` or `METRES,SHARE`.
    fn from_str(text: &str) -> Result<Self, String> {
        let [metres, share] = numbers(text)
            .or_else(|| numbers(text).map(|[metres]| [metres, 0.0]))
            .ok_or_else(|| format!("{text:?} is not a noise; needed is METRES or METRES,SHARE"))?;
        Ok(Noise {
            sigma_m: within(metres, &(0.0..=2.0), "metres")?,
            sigma_per_m: within(share, &(0.0..=0.25), "as a share of the range")?,
        })
    }
}

/// Converts true ranges to readings.
#[derive(Debug)]
pub(crate) struct Receiver {
    pub noise: Noise,
    /// Share of random readings.
    pub outliers: f64,
    pub range_max_m: f64,
    pub rng: Xoshiro256PlusPlus,
}

impl Receiver {
    /// Returns the reading for a true range, in metres; infinite without a return.
    pub(crate) fn reading(&mut self, true_m: Option<f64>) -> f32 {
        // Drawn for every reading, so that one does not change those after it.
        let error: f64 = StandardNormal.sample(&mut self.rng);
        let [chance, share]: [f64; 2] = [self.rng.random(), self.rng.random()];
        if chance < self.outliers {
            return whole_steps(share * self.range_max_m);
        }
        let Some(true_m) = true_m else {
            return f32::INFINITY;
        };
        let sigma_m = self.noise.sigma_m + self.noise.sigma_per_m * true_m;
        let reading_m = true_m + sigma_m * error;
        match reading_m <= self.range_max_m {
            true => whole_steps(reading_m.max(0.0)),
            false => f32::INFINITY,
        }
    }
}

fn whole_steps(metres: f64) -> f32 {
    ((metres * STEPS_PER_METRE).round() / STEPS_PER_METRE) as f32
}

#[cfg(test)]
mod tests {
    use rand::SeedableRng;

    use super::*;

    const READINGS: usize = 20_000;

    fn readings(noise: &str, outliers: f64, true_m: Option<f64>) -> Vec<f64> {
        let mut receiver = Receiver {
            noise: noise.parse().unwrap(),
            outliers,
            range_max_m: 10.0,
            rng: Xoshiro256PlusPlus::seed_from_u64(3),
        };
        (0..READINGS)
            .map(|_| f64::from(receiver.reading(true_m)))
            .collect()
    }

    #[test]
    fn errors_have_the_deviation_that_was_asked_for() {
        for (noise, true_m, sigma_m) in [("0.02", 4.0, 0.02), ("0.02,0.03", 4.0, 0.14)] {
            let readings = readings(noise, 0.0, Some(true_m));
            let count = readings.len() as f64;
            let mean = readings.iter().sum::<f64>() / count;
            let squares = readings.iter().map(|reading| (reading - true_m).powi(2));
            let deviation = (squares.sum::<f64>() / count).sqrt();
            // The mean of n is off by σ/√n, the deviation by σ/√2n, in one of three cases; allowed
            // are four times that, and the rounding to a millimetre.
            let allowed = 4.0 * sigma_m / count.sqrt() + 0.0005;
            assert!((mean - true_m).abs() < allowed, "{noise}: mean {mean}");
            assert!(
                (deviation - sigma_m).abs() < allowed,
                "{noise}: {deviation}"
            );
        }
    }

    #[test]
    fn outliers_are_anything_and_as_many_as_asked_for() {
        let readings = readings("0", 0.2, Some(4.0));
        let outliers: Vec<f64> = readings.into_iter().filter(|&r| r != 4.0).collect();
        let share = outliers.len() as f64 / READINGS as f64;
        // Four standard deviations of a count of 20,000 at 0.2 are 0.0113; one outlier in 10,000
        // rounds to the true range.
        assert!((share - 0.2).abs() < 0.012, "{share}");
        let mean = outliers.iter().sum::<f64>() / outliers.len() as f64;
        // Uniform over 10 m: 2.89 m / √4000 is 0.046 m; four of those.
        assert!((mean - 5.0).abs() < 0.19, "{mean}");
    }

    #[test]
    fn what_does_not_return_is_infinite_and_no_reading_exceeds_the_range() {
        assert!(readings("0.5", 0.0, None).iter().all(|r| r.is_infinite()));
        let near_the_end = readings("0.1", 0.0, Some(10.0));
        assert!(near_the_end.iter().any(|r| r.is_infinite()));
        assert!(near_the_end.iter().all(|r| r.is_infinite() || *r <= 10.0));
        assert!(readings("0.5", 0.0, Some(0.1)).iter().all(|&r| r >= 0.0));
    }

    #[test]
    fn nonsense_is_refused_by_what_is_wrong() {
        let refused = |text: &str| text.parse::<Noise>().unwrap_err();
        assert!(refused("much").contains("needed is METRES or METRES,SHARE"));
        assert_eq!(refused("-1"), "-1 is not within 0 to 2 metres");
        assert_eq!(
            refused("0,1"),
            "1 is not within 0 to 0.25 as a share of the range"
        );
    }
}
