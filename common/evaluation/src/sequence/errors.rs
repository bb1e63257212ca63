//! How far a trajectory is from the true one, as evo defines it: poses of the same stamp
//! are compared as they are, in the map's frame.

use geometry::Pose;
use serde::Serialize;

/// Of the poses that have a truth; `None` where there are none, or no two in a row.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub(super) struct Errors {
    /// How many poses were compared.
    pub(super) poses: usize,
    /// The absolute pose error, its translation (`evo_ape -r trans_part`), metres.
    pub(super) ape_m: Option<Spread>,
    /// The relative pose error from each pose to the next, its translation
    /// (`evo_rpe -r trans_part --delta 1 --delta_unit f`), metres.
    pub(super) rpe_m: Option<Spread>,
    /// Its rotation (`-r angle_deg`), degrees.
    pub(super) rpe_deg: Option<Spread>,
}

/// Of all errors.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub(super) struct Spread {
    /// The root of the mean square.
    pub(super) rmse: f64,
    /// The mean of the two in the middle where their number is even.
    pub(super) median: f64,
    pub(super) max: f64,
}

impl Errors {
    /// Of found and true poses, in the order of their stamps.
    pub(super) fn of(pairs: &[(Pose, Pose)]) -> Self {
        let absolute = pairs
            .iter()
            .map(|(found, truth)| found.distance_to(*truth))
            .collect();
        let step = |from: Pose, to: Pose| from.inverse().then(to);
        let relative: Vec<Pose> = pairs
            .windows(2)
            .map(|pair| {
                let [(found, truth), (next_found, next_truth)] = [pair[0], pair[1]];
                step(step(truth, next_truth), step(found, next_found))
            })
            .collect();
        let metres = relative.iter().map(|off| off.x.hypot(off.y)).collect();
        let degrees = relative.iter().map(|off| off.yaw.abs().to_degrees());
        Errors {
            poses: pairs.len(),
            ape_m: Spread::of(absolute),
            rpe_m: Spread::of(metres),
            rpe_deg: Spread::of(degrees.collect()),
        }
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
        assert_eq!(Errors::of(&[]).ape_m, None);
        let at = |x: f64, y: f64| Pose::new(x, y, 0.0);
        // A tenth to the left from the start on, and 0.3 more at the last.
        let pairs = [
            (at(0.0, 0.1), at(0.0, 0.0)),
            (at(1.0, 0.1), at(1.0, 0.0)),
            (at(2.0, 0.4), at(2.0, 0.0)),
        ];
        let Errors {
            poses,
            ape_m,
            rpe_m,
            rpe_deg,
        } = Errors::of(&pairs);
        let near = |found: Option<Spread>, expected: [f64; 3]| {
            let found = found.unwrap();
            let found = [found.rmse, found.median, found.max];
            let is_near = found
                .iter()
                .zip(expected)
                .all(|(f, e)| (f - e).abs() < 1e-12);
            assert!(is_near, "{found:?} {expected:?}");
        };
        assert_eq!(poses, 3);
        near(ape_m, [0.06f64.sqrt(), 0.1, 0.4]);
        near(rpe_m, [0.045f64.sqrt(), 0.15, 0.3]);
        near(rpe_deg, [0.0; 3]);
    }
}
