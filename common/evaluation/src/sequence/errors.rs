//! Errors of a trajectory as evo defines them: poses with the same stamp are compared without
//! alignment, in the map's frame.

use geometry::Pose;
use schemars::JsonSchema;
use serde::Serialize;

use crate::text::number;

/// Errors of each pose with a known truth, of one drive or of several.
#[derive(Debug, Clone, Default)]
pub(crate) struct Samples {
    absolute_m: Vec<f64>,
    relative_m: Vec<f64>,
    relative_deg: Vec<f64>,
}

/// Figures of these errors; `None` for an error without samples.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, JsonSchema)]
pub(crate) struct Errors {
    /// Number of poses compared.
    pub(super) poses: usize,
    /// Absolute pose error, translation (`evo_ape -r trans_part`), in metres.
    pub(super) ape_m: Option<Spread>,
    /// Relative pose error from each pose to the next, translation (`evo_rpe -r trans_part --delta
    /// 1 --delta_unit f`), in metres.
    pub(super) rpe_m: Option<Spread>,
    /// Relative pose error, rotation (`-r angle_deg`), in degrees.
    pub(super) rpe_deg: Option<Spread>,
}

#[derive(Debug, Clone, Copy, PartialEq, Serialize, JsonSchema)]
pub(super) struct Spread {
    /// Root mean square error.
    pub(super) rmse: f64,
    /// Mean of the two middle values for an even number.
    pub(super) median: f64,
    pub(super) max: f64,
}

impl Samples {
    /// Errors of pairs of found and true pose, in the order of their stamps.
    pub(crate) fn of(pairs: &[(Pose, Pose)]) -> Self {
        let absolute = pairs.iter().map(|(found, truth)| found.distance_to(*truth));
        let step = |from: Pose, to: Pose| from.inverse().then(to);
        let relative: Vec<Pose> = pairs
            .windows(2)
            .map(|pair| {
                let [(found, truth), (next_found, next_truth)] = [pair[0], pair[1]];
                step(step(truth, next_truth), step(found, next_found))
            })
            .collect();
        let metres = relative.iter().map(|off| off.x.hypot(off.y));
        let degrees = relative.iter().map(|off| off.yaw.abs().to_degrees());
        Samples {
            absolute_m: absolute.collect(),
            relative_m: metres.collect(),
            relative_deg: degrees.collect(),
        }
    }

    pub(super) fn merge(&mut self, other: &Self) {
        self.absolute_m.extend(&other.absolute_m);
        self.relative_m.extend(&other.relative_m);
        self.relative_deg.extend(&other.relative_deg);
    }

    pub(crate) fn figures(&self) -> Errors {
        Errors {
            poses: self.absolute_m.len(),
            ape_m: Spread::of(self.absolute_m.clone()),
            rpe_m: Spread::of(self.relative_m.clone()),
            rpe_deg: Spread::of(self.relative_deg.clone()),
        }
    }
}

impl Errors {
    pub(crate) fn text(&self) -> String {
        let spread = |spread: Option<Spread>, decimals| match spread {
            Some(Spread { rmse, median, max }) => [rmse, median, max]
                .map(|error| number(Some(error), decimals))
                .join(" / "),
            None => "-".to_owned(),
        };
        format!(
            "{} poses, RMSE / median / max: APE {} m; RPE {} m, {}°",
            self.poses,
            spread(self.ape_m, 3),
            spread(self.rpe_m, 3),
            spread(self.rpe_deg, 2),
        )
    }
}

impl Spread {
    fn of(mut errors: Vec<f64>) -> Option<Self> {
        errors.sort_by(f64::total_cmp);
        let max = *errors.last()?;
        let half = errors.len() / 2;
        let median = match errors.len().is_multiple_of(2) {
            true => 0.5 * (errors[half - 1] + errors[half]),
            false => errors[half],
        };
        let squares: f64 = errors.iter().map(|error| error * error).sum();
        Some(Spread {
            rmse: (squares / errors.len() as f64).sqrt(),
            median,
            max,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_stays_off_counts_once_and_what_jumps_counts_in_each_step() {
        assert_eq!(Samples::of(&[]).figures().ape_m, None);
        let at = |x: f64, y: f64| Pose::new(x, y, 0.0);
        // Off by 0.1 m to the left from the start, and by 0.4 m at the last pose.
        let pairs = [
            (at(0.0, 0.1), at(0.0, 0.0)),
            (at(1.0, 0.1), at(1.0, 0.0)),
            (at(2.0, 0.4), at(2.0, 0.0)),
        ];
        let errors = Samples::of(&pairs).figures();
        let near = |found: Option<Spread>, expected: [f64; 3]| {
            let found = found.unwrap();
            let found = [found.rmse, found.median, found.max];
            let mut both = found.iter().zip(expected);
            let is_near = both.all(|(f, e)| (f - e).abs() < 1e-12);
            assert!(is_near, "{found:?} {expected:?}");
        };
        assert_eq!(errors.poses, 3);
        near(errors.ape_m, [0.06f64.sqrt(), 0.1, 0.4]);
        near(errors.rpe_m, [0.045f64.sqrt(), 0.15, 0.3]);
        near(errors.rpe_deg, [0.0; 3]);
    }
}
