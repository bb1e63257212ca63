//! What a scan says for a particle: the likelihood field model or the beam model of
//! Probabilistic Robotics, sections 6.4 and 6.3.
//!
//! Weights are compared with each other alone, so that each likelihood is given as a
//! share of that of a reading that fits exactly: the parts of the models are scaled to
//! a greatest value of 1 where the book has densities (so does AMCL). The sum of the
//! parts is at most 1. Where the models differ otherwise from the book:
//!
//! - Beams of which nothing returned say nothing, for no range is known below which
//!   they would have; table 6.1 gives them a share of their own.
//! - Beams count by their weights, and together as a few independent ones: the
//!   likelihood is raised to a power below 1, as section 6.3.4 advises.
//! - Who stands off the map or in an obstacle explains nothing.

use super::beams::{Beam, Beams};
use super::{ParticlesConfig, SensorModel};
use crate::fit::{DistanceField, GridPose};

/// Steps of a standard deviation at which the likelihood field is kept: between two, the
/// likelihood differs by less than 2 %.
const STEPS: f64 = 32.0;

/// Beyond this many standard deviations a reading does not fit at all: 3 · 10⁻⁴ of the
/// greatest likelihood, which is less than any random share.
const REACH: f64 = 4.0;

/// The share of readings that are shorter than the map says, for somebody stands in the
/// way; a tenth of those that fit, as `z_short` and `z_hit` of AMCL.
const SHORT_SHARE: f64 = 0.1;

/// The way after which somebody in the way is less likely by a factor of e, metres:
/// 1 / `lambda_short` of AMCL.
const SHORT_M: f64 = 10.0;

/// What a beam is worth that ends behind unknown space: as in the fit,
/// `FitConfig::unknown_score`.
const UNKNOWN: f64 = 0.3;

/// A sensor model, prepared for maps of one resolution.
#[derive(Debug, Clone)]
pub(super) struct Sensor {
    model: SensorModel,
    /// Standard deviation, cells.
    sigma: f64,
    random: f64,
    short_cells: f64,
    /// Logarithms of the likelihood of an end point at each [`STEPS`]th of a standard
    /// deviation from the nearest obstacle; the last is that of all that are farther.
    field: Vec<f64>,
    /// Steps for each cell of distance.
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
            model: config.particles_model,
            sigma,
            random,
            short_cells: SHORT_M / resolution_m,
            field: near.chain([random.ln()]).collect(),
            steps_per_cell: STEPS / sigma,
        }
    }

    /// The logarithm of the likelihood of the beams at a pose, at most 0.
    pub(super) fn log_likelihood(
        &self,
        distance_field: &DistanceField,
        beams: &Beams,
        pose: GridPose,
    ) -> f64 {
        let stands = distance_field.cell_distance(pose.x, pose.y);
        if stands.is_none_or(|distance| distance == 0.0) {
            return beams.weight * self.random.ln();
        }
        let turn = pose.heading.sin_cos();
        let beams = beams.beams.iter();
        match self.model {
            SensorModel::LikelihoodField => beams
                .map(|beam| beam.weight * self.end(distance_field, beam, pose, turn))
                .sum(),
            SensorModel::Beam => beams
                .map(|beam| beam.weight * self.reading(distance_field, beam, pose, turn).ln())
                .sum(),
        }
    }

    /// Table 6.3: by the nearest obstacle of the end point. The distance is that of the
    /// cell, up to 0.7 cells off, which is one look-up where the exact one takes four.
    #[inline(always)]
    fn end(
        &self,
        distance_field: &DistanceField,
        beam: &Beam,
        pose: GridPose,
        turn: (f64, f64),
    ) -> f64 {
        let (x, y) = turned(beam.end, turn);
        let distance = distance_field.cell_distance(pose.x + x, pose.y + y);
        let far = self.field.len() - 1;
        let step = distance.map_or(far, |cells| {
            (f64::from(cells) * self.steps_per_cell) as usize
        });
        self.field[step.min(far)]
    }

    /// Table 6.1: by the way to the first obstacle.
    fn reading(
        &self,
        distance_field: &DistanceField,
        beam: &Beam,
        pose: GridPose,
        turn: (f64, f64),
    ) -> f64 {
        let (x, y) = turned(beam.from, turn);
        let limit = beam.cells + REACH * self.sigma;
        let laser = (pose.x + x, pose.y + y);
        let hit = distance_field.cast_ray(laser, turned(beam.towards, turn), limit);
        let expected = hit.occupied.unwrap_or(f64::INFINITY);
        let fits = fit((beam.cells - expected) / self.sigma);
        let is_short = beam.cells < expected;
        let short = f64::from(is_short) * (-beam.cells / self.short_cells).exp();
        let known = self.random + SHORT_SHARE * short + (1.0 - self.random - SHORT_SHARE) * fits;
        match hit.unknown {
            Some(unknown) if unknown < beam.cells => known.max(UNKNOWN),
            _ => known,
        }
    }
}

/// The likelihood of an error in standard deviations, as a share of that of none.
fn fit(deviations: f64) -> f64 {
    (-0.5 * deviations * deviations).exp()
}

#[inline(always)]
fn turned((x, y): (f64, f64), (sin, cos): (f64, f64)) -> (f64, f64) {
    (x * cos - y * sin, x * sin + y * cos)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fit::drawn::distance_field;

    /// A wall at 8 cells, behind it open space, and unknown space above.
    const MAP: [&str; 5] = [
        "......??????",
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

    /// σ is two cells of 0.1 m.
    fn sensor(model: SensorModel) -> Sensor {
        let config = ParticlesConfig {
            particles_model: model,
            particles_random: 0.1,
            ..ParticlesConfig::default()
        };
        Sensor::new(&config, 0.1)
    }

    fn beams(bearing: f64, cells: f64) -> Beams {
        let (sin, cos) = bearing.sin_cos();
        let beam = Beam {
            end: (cells * cos, cells * sin),
            from: (0.0, 0.0),
            towards: (cos, sin),
            cells,
            weight: 1.0,
        };
        Beams {
            beams: vec![beam],
            weight: 1.0,
        }
    }

    #[track_caller]
    fn check(model: SensorModel, pose: GridPose, (bearing, cells): (f64, f64), expected: f64) {
        let beams = beams(bearing, cells);
        let log = sensor(model).log_likelihood(&distance_field(&MAP), &beams, pose);
        assert!((log.exp() - expected).abs() < 1e-9, "{}", log.exp());
    }

    #[test]
    fn an_end_point_at_a_wall_is_likely_and_one_in_the_open_is_not() {
        let field = |ray, expected| check(SensorModel::LikelihoodField, POSE, ray, expected);
        field((0.0, 8.0), 1.0);
        // One and two deviations before and behind it, off to a side, and far away.
        field((0.0, 6.0), 0.1 + 0.9 * (-0.5f64).exp());
        field((0.0, 10.0), 0.1 + 0.9 * (-0.5f64).exp());
        field((0.0, 4.0), 0.1 + 0.9 * (-2.0f64).exp());
        field((0.0, 0.0), 0.1);
        field((0.0, 30.0), 0.1);
    }

    #[test]
    fn a_reading_as_long_as_the_way_is_likely_and_a_longer_one_is_not() {
        let beam = |ray, expected| check(SensorModel::Beam, POSE, ray, expected);
        // The wall's face is at 7.5 cells; a ray meets it up to half a cell behind.
        let hit = distance_field(&MAP).cast_ray((0.5, 2.5), (1.0, 0.0), 20.0);
        let wall = hit.occupied.unwrap();
        assert!((7.5..=8.0).contains(&wall));
        beam((0.0, wall), 0.1 + 0.8);
        // Two deviations behind, where nothing is short; and far behind.
        beam((0.0, wall + 4.0), 0.1 + 0.8 * (-2.0f64).exp());
        // In the way stands somebody; 100 cells are the way of a factor of e.
        let far = 0.8 * fit((wall - 1.0) / 2.0);
        beam((0.0, 1.0), 0.1 + 0.1 * (-0.01f64).exp() + far);
        // Through unknown space anything may be read.
        beam((0.2, 11.0), UNKNOWN);
    }

    #[test]
    fn who_stands_in_an_obstacle_or_off_the_map_explains_nothing() {
        for (x, y) in [(8.5, 2.5), (-1.0, 2.5), (3.0, 5.1)] {
            let pose = GridPose { x, y, ..POSE };
            for model in [SensorModel::LikelihoodField, SensorModel::Beam] {
                check(model, pose, (0.0, 8.0), 0.1);
            }
        }
    }
}
