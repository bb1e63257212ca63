//! Start poses of a particle filter, drawn around the places of a search.

use geometry::{Covariance, Pose, wrap_angle};
use nalgebra::{Matrix3, SymmetricEigen, Vector3};
use rand::rngs::Xoshiro256PlusPlus;
use rand::{RngExt, SeedableRng};
use rand_distr::{Distribution, StandardNormal};

use crate::EngineError;
use crate::fit::GridPose;
use crate::grid::GridFrame;
use crate::peaks::Place;

/// Generator of all random numbers; one of `rand` whose numbers do not change between versions.
pub type Rng = Xoshiro256PlusPlus;

/// A place where the robot may be.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Candidate {
    /// Pose of the target frame, in the map.
    pub map_from_target: Pose,
    /// Covariance of the pose, in the map.
    pub covariance: Covariance,
    /// Probability of the place relative to the other candidates.
    pub weight: f64,
}

impl From<&Place> for Candidate {
    fn from(place: &Place) -> Self {
        Candidate {
            map_from_target: place.map_from_laser,
            covariance: place.covariance,
            weight: place.probability,
        }
    }
}

/// Draws `count` poses in the map around candidates, as the start of any particle filter: around
/// each in proportion to its weight, and spread by its covariance (the paper, section VI: "those
/// places where particles need to be initialized"). All poses weigh the same. `frame` is that of
/// the map's cells; the same seed gives the same poses.
///
/// # Errors
/// If no candidate has finite numbers and a weight of at least 0.
pub fn draw(
    frame: GridFrame,
    candidates: impl IntoIterator<Item = Candidate>,
    count: usize,
    seed: u64,
) -> Result<Vec<Pose>, EngineError> {
    let seeds = Seeds::new(frame, candidates)?;
    let mut rng = Rng::seed_from_u64(seed);
    let pose = |GridPose { x, y, heading }| frame.map_from_cells(x, y, heading);
    Ok((0..count).map(|_| pose(seeds.draw(&mut rng))).collect())
}

/// Smallest standard deviations of a candidate, in cells and degrees. It was refined by the scan
/// that weighs the particles next, and that scan must not count twice.
const MIN_CELLS: f64 = 0.5;
const MIN_DEG: f64 = 1.0;

/// Draws poses around candidates, in proportion to their weights.
pub struct Seeds {
    seeds: Vec<Seed>,
    total: f64,
}

struct Seed {
    pose: GridPose,
    /// Matrix that converts independent normal numbers to an error in cells and radians.
    root: Matrix3<f64>,
    weight: f64,
}

impl Seeds {
    /// Prepares the candidates. Those with numbers that are not finite or a negative weight are
    /// dropped; if all weights are 0, all weigh the same.
    ///
    /// # Errors
    /// If no candidate is left.
    pub fn new(
        frame: GridFrame,
        candidates: impl IntoIterator<Item = Candidate>,
    ) -> Result<Self, EngineError> {
        let seeds = candidates.into_iter().filter_map(|c| Seed::new(frame, &c));
        let mut seeds: Vec<Seed> = seeds.collect();
        if seeds.iter().all(|seed| seed.weight == 0.0) {
            seeds.iter_mut().for_each(|seed| seed.weight = 1.0);
        }
        if seeds.is_empty() {
            return Err(EngineError::NoStart);
        }
        let total = seeds.iter().map(|seed| seed.weight).sum();
        Ok(Seeds { seeds, total })
    }

    /// Draws a random pose, in cells of the grid.
    pub fn draw(&self, rng: &mut Rng) -> GridPose {
        let mut left = self.total * rng.random::<f64>();
        let is_it = |seed: &&Seed| {
            left -= seed.weight;
            left < 0.0
        };
        // Rounding of the sum may leave a rest; then the last one is taken.
        let last = &self.seeds[self.seeds.len() - 1];
        let seed = self.seeds.iter().find(is_it).unwrap_or(last);
        let mut normal = || -> f64 { StandardNormal.sample(rng) };
        let error = seed.root * Vector3::new(normal(), normal(), normal());
        GridPose {
            x: seed.pose.x + error.x,
            y: seed.pose.y + error.y,
            heading: wrap_angle(seed.pose.heading + error.z),
        }
    }
}

impl Seed {
    fn new(frame: GridFrame, candidate: &Candidate) -> Option<Self> {
        let Candidate {
            map_from_target,
            covariance,
            weight,
        } = *candidate;
        let covariance = Matrix3::from(covariance);
        let pose = GridPose::of(frame, map_from_target);
        let GridPose { x, y, heading } = &pose;
        let mut numbers = covariance.iter().chain([x, y, heading, &weight]);
        if !(numbers.all(|number| number.is_finite()) && weight >= 0.0) {
            return None;
        }
        Some(Seed {
            pose,
            root: root(in_cells(frame, covariance))?,
            weight,
        })
    }
}

/// Converts the covariance of a pose from the map to cells along the grid's axes and radians.
fn in_cells(frame: GridFrame, covariance: Matrix3<f64>) -> Matrix3<f64> {
    let (sin, cos) = frame.map_from_grid.yaw.sin_cos();
    let scale = 1.0 / frame.resolution_m;
    let (s, c) = (scale * sin, scale * cos);
    let turn = Matrix3::new(c, s, 0.0, -s, c, 0.0, 0.0, 0.0, 1.0);
    turn * covariance * turn.transpose()
}

/// Root of a covariance that is widened by the smallest one. The covariance may be flat, if the
/// heading was known.
fn root(covariance: Matrix3<f64>) -> Option<Matrix3<f64>> {
    const MAX_STEPS: usize = 100;
    let least = MIN_DEG.to_radians();
    let least = Vector3::new(MIN_CELLS, MIN_CELLS, least).map(|d| d * d);
    let wide = covariance + Matrix3::from_diagonal(&least);
    let SymmetricEigen {
        eigenvalues,
        eigenvectors,
    } = SymmetricEigen::try_new(wide, f64::EPSILON, MAX_STEPS)?;
    let roots = eigenvalues.map(|value| value.max(0.0).sqrt());
    Some(eigenvectors * Matrix3::from_diagonal(&roots))
}

#[cfg(test)]
mod tests {
    use super::*;

    const FRAME: GridFrame = GridFrame::new(0.1, Pose::new(3.0, -1.0, 0.5));

    fn candidate(x: f64, weight: f64) -> Candidate {
        Candidate {
            map_from_target: Pose::new(x, 2.0, 1.0),
            covariance: Covariance::from_deviations(0.3, 0.1, 0.05),
            weight,
        }
    }

    #[test]
    fn candidates_are_drawn_by_their_weights_and_spreads() {
        let seeds = Seeds::new(FRAME, [candidate(0.0, 0.2), candidate(50.0, 0.6)]).unwrap();
        let mut rng = Rng::seed_from_u64(1);
        let drawn: Vec<Pose> = (0..8000)
            .map(|_| seeds.draw(&mut rng))
            .map(|p| FRAME.map_from_cells(p.x, p.y, p.heading))
            .collect();
        let first: Vec<&Pose> = drawn.iter().filter(|pose| pose.x < 25.0).collect();
        // The expectation is 2000 of 8000, with a standard deviation of 39; four of those are
        // allowed.
        assert!(first.len().abs_diff(2000) < 156, "{}", first.len());
        let deviation = |of: &dyn Fn(&Pose) -> f64| {
            let squares: f64 = first.iter().map(|pose| of(pose).powi(2)).sum();
            (squares / first.len() as f64).sqrt()
        };
        // Half a cell and a degree are added; 2000 samples give a standard deviation to 1.6 %, and
        // four times that is allowed.
        let check = |found: f64, asked: f64, least: f64| {
            let expected = asked.hypot(least);
            assert!((found / expected - 1.0).abs() < 0.064, "{found} {expected}");
        };
        check(deviation(&|p| p.x), 0.3, 0.05);
        check(deviation(&|p| p.y - 2.0), 0.1, 0.05);
        check(deviation(&|p| p.yaw - 1.0), 0.05, 1f64.to_radians());
    }

    #[test]
    fn as_many_are_drawn_as_asked_for_and_the_same_with_a_seed() {
        let around = || [candidate(0.0, 0.2), candidate(50.0, 0.6)];
        let drawn = draw(FRAME, around(), 100, 7).unwrap();
        assert_eq!(drawn.len(), 100);
        assert_eq!(draw(FRAME, around(), 100, 7).unwrap(), drawn);
        assert_ne!(draw(FRAME, around(), 100, 8).unwrap(), drawn);
        // Five standard deviations, with half a cell added.
        let near = |pose: &Pose| pose.x.abs().min((pose.x - 50.0).abs()) < 5.0 * 0.31;
        assert!(drawn.iter().all(near));
        assert_eq!(draw(FRAME, [], 1, 1), Err(EngineError::NoStart));
    }

    #[test]
    fn candidates_that_are_no_numbers_are_left_out() {
        let mut broken = candidate(0.0, 1.0);
        broken.covariance = Covariance::from_deviations(0.3, f64::NAN, 0.05);
        let refused = Seeds::new(FRAME, [broken, candidate(1.0, -1.0)]);
        assert_eq!(refused.err(), Some(EngineError::NoStart));
        let seeds = Seeds::new(FRAME, [broken, candidate(0.0, 0.0), candidate(9.0, 0.0)]);
        let seeds = seeds.unwrap();
        assert_eq!((seeds.seeds.len(), seeds.total), (2, 2.0), "weigh the same");
    }
}
