//! Likelihood of a scan for a particle: the likelihood field model of Probabilistic Robotics,
//! section 6.4.
//!
//! Only ratios of weights matter, so each likelihood is a share of that of a reading that fits
//! exactly: the parts of the model are scaled to a maximum of 1 in place of the book's densities
//! (as in AMCL). Other differences from the book:
//!
//! - Beams without a return are ignored, since the range below which they would have returned is
//!   not known; table 6.1 gives them a separate share.
//! - Beams count as a few independent ones: the likelihood is raised to a power below 1, as
//!   section 6.3.4 advises.
//! - A pose off the map or in an obstacle explains no reading.

use engine::fit::{DistanceField, GridPose};

use super::ParticlesConfig;
use super::beams::Beams;

/// Steps per standard deviation in the likelihood table: the likelihood differs by less than 2 %
/// between two steps.
const STEPS: f64 = 32.0;

/// Standard deviations beyond which a reading does not fit at all: 3 · 10⁻⁴ of the maximum
/// likelihood, less than any random share.
const REACH: f64 = 4.0;

/// Sensor model, prepared for maps of one resolution.
#[derive(Debug, Clone)]
pub(super) struct Sensor {
    random: f64,
    /// Log-likelihood of an end point at each [`STEPS`]th of a standard deviation from the nearest
    /// obstacle; the last one is for all larger distances.
    field: Vec<f64>,
    /// Table steps per cell of distance.
    steps_per_cell: f64,
}

impl Sensor {
    pub(super) fn new(config: &ParticlesConfig, resolution_m: f64) -> Self {
        let sigma = (config.particles_sigma_m / resolution_m).max(1.0);
        let random = config.particles_random;
        let last = (REACH * STEPS) as usize;
        let value = |step: usize| {
            let hit = fit(step as f64 / STEPS);
            (random + (1.0 - random) * hit).ln()
        };
        let near = (0..last).map(value);
        Sensor {
            random,
            field: near.chain([random.ln()]).collect(),
            steps_per_cell: STEPS / sigma,
        }
    }

    /// Log-likelihood of the beams at a pose, at most 0.
    pub(super) fn log_likelihood(
        &self,
        distance_field: &DistanceField,
        beams: &Beams,
        pose: GridPose,
    ) -> f64 {
        let stands = distance_field.cell_distance(pose.x, pose.y);
        if stands.is_none_or(|distance| distance == 0.0) {
            return beams.together() * self.random.ln();
        }
        let turn = pose.heading.sin_cos();
        let ends = beams.ends.iter();
        let of_beam = |&end: &(f64, f64)| self.end(distance_field, end, pose, turn);
        beams.weight * ends.map(of_beam).sum::<f64>()
    }

    /// Log-likelihood by the nearest obstacle of the end point (table 6.3). The distance is that of
    /// the cell, up to 0.7 cells off: one look-up, where the exact distance needs four.
    #[inline(always)]
    fn end(
        &self,
        distance_field: &DistanceField,
        end: (f64, f64),
        pose: GridPose,
        turn: (f64, f64),
    ) -> f64 {
        let (x, y) = turned(end, turn);
        let distance = distance_field.cell_distance(pose.x + x, pose.y + y);
        let far = self.field.len() - 1;
        let step = distance.map_or(far, |cells| {
            (f64::from(cells) * self.steps_per_cell) as usize
        });
        self.field[step.min(far)]
    }
}

/// Likelihood of an error in standard deviations, as a share of the maximum.
fn fit(deviations: f64) -> f64 {
    (-0.5 * deviations * deviations).exp()
}

#[inline(always)]
fn turned((x, y): (f64, f64), (sin, cos): (f64, f64)) -> (f64, f64) {
    (x * cos - y * sin, x * sin + y * cos)
}

#[cfg(test)]
mod tests {
    use super::super::drawn::distance_field;
    use super::*;

    /// A wall at 8 cells.
    const MAP: [&str; 5] = [
        "............",
        "............",
        "........#...",
        "............",
        "............",
    ];
    const POSE: GridPose = GridPose {
        x: 0.5,
        y: 2.5,
        heading: 0.0,
    };

    #[track_caller]
    fn check(pose: GridPose, cells: f64, expected: f64) {
        // σ is two cells of 0.1 m.
        let config = ParticlesConfig {
            particles_random: 0.1,
            ..ParticlesConfig::default()
        };
        let beams = Beams {
            ends: vec![(cells, 0.0)],
            weight: 1.0,
        };
        let log = Sensor::new(&config, 0.1).log_likelihood(&distance_field(&MAP), &beams, pose);
        assert!((log.exp() - expected).abs() < 1e-9, "{}", log.exp());
    }

    #[test]
    fn an_end_point_at_a_wall_is_likely_and_one_in_the_open_is_not() {
        check(POSE, 8.0, 1.0);
        // At one and two standard deviations before and behind the wall, and far away.
        check(POSE, 6.0, 0.1 + 0.9 * (-0.5f64).exp());
        check(POSE, 10.0, 0.1 + 0.9 * (-0.5f64).exp());
        check(POSE, 4.0, 0.1 + 0.9 * (-2.0f64).exp());
        check(POSE, 0.0, 0.1);
        check(POSE, 30.0, 0.1);
    }

    #[test]
    fn who_stands_in_an_obstacle_or_off_the_map_explains_nothing() {
        for (x, y) in [(8.5, 2.5), (-1.0, 2.5), (3.0, 5.1)] {
            check(GridPose { x, y, ..POSE }, 8.0, 0.1);
        }
    }
}
