//! Markov localization, the paper's comparison (section II B): casts a ray from each pose for each
//! reading, and sums the squared errors.

use engine::space::Space;

use super::Baseline;
use super::best::{Best, Estimate};
use super::clearance::Clearance;
use super::reading::{Expected, MAX_DEVIATIONS, MAX_PENALTY, Readings};
use crate::worlds::World;

/// Markov localization by ray casts, without pruning. Rays skip free space.
#[derive(Debug, Clone)]
pub struct RayCasting {
    space: Space,
    clearance: Clearance,
    /// Cells in which the robot can be.
    free: Vec<(u16, u16)>,
}

#[derive(Debug, Clone, Copy)]
struct Beam {
    direction: usize,
    expected: Expected,
    /// Number of steps from which the error is at its maximum.
    limit: i64,
}

impl RayCasting {
    pub fn new(world: &World, space: &Space) -> Self {
        let grid = &world.grid;
        let cells = (0..grid.height()).flat_map(|y| (0..grid.width()).map(move |x| (x, y)));
        RayCasting {
            space: space.clone(),
            clearance: Clearance::new(world),
            free: cells
                .filter(|&(x, y)| grid.is_open(x as i64, y as i64))
                .map(|(x, y)| (x as u16, y as u16))
                .collect(),
        }
    }

    /// Makes rays walk cell by cell instead of skipping free space, with the same results.
    pub fn with_single_steps(self) -> Self {
        RayCasting {
            clearance: self.clearance.with_single_steps(),
            ..self
        }
    }

    fn beams(&self, readings: &Readings, heading: usize) -> Vec<Beam> {
        let count = self.space.directions.count();
        let beam = |reading: &super::Reading| {
            let direction = (heading + reading.bearing) % count;
            let steps_per_cell = self.space.directions.get(direction).steps_per_cell;
            let farthest = reading.cells + f64::from(MAX_DEVIATIONS) * reading.sigma_cells;
            Beam {
                direction,
                expected: reading.along(steps_per_cell),
                limit: (farthest * steps_per_cell).ceil() as i64,
            }
        };
        readings.beams.iter().map(beam).collect()
    }

    /// Twice the negative log-likelihood, up to a constant.
    fn cost(&self, x: usize, y: usize, beams: &[Beam]) -> f32 {
        let error = |beam: &Beam| {
            let direction = self.space.directions.get(beam.direction);
            let range = self.clearance.range(x, y, direction, beam.limit);
            range.map_or(MAX_PENALTY, |steps| beam.expected.penalty(steps as f32))
        };
        beams.iter().map(error).sum()
    }

    /// Returns the best of some poses, given as column, row and heading of free cells. Sorting them
    /// by heading is fastest, since the beams are prepared per heading.
    pub fn locate_among(
        &self,
        readings: &Readings,
        poses: impl IntoIterator<Item = (usize, usize, usize)>,
    ) -> Option<Estimate> {
        let mut best = Best::default();
        let (mut beams, mut at) = (Vec::new(), None);
        for (x, y, heading) in poses {
            if at != Some(heading) {
                beams = self.beams(readings, heading);
                at = Some(heading);
            }
            best.take(Estimate::new(x, y, heading, -self.cost(x, y, &beams)));
        }
        best.get()
    }
}

impl Baseline for RayCasting {
    fn locate(&mut self, readings: &Readings, headings: &[usize]) -> Option<Estimate> {
        let mut best = Best::default();
        for &heading in headings {
            let beams = self.beams(readings, heading);
            for &(x, y) in &self.free {
                let (x, y) = (usize::from(x), usize::from(y));
                let score = -self.cost(x, y, &beams);
                if score >= best.score() {
                    best.take(Estimate::new(x, y, heading, score));
                }
            }
        }
        best.get()
    }

    fn bytes(&self) -> usize {
        self.clearance.bytes() + size_of_val(&self.free[..])
    }
}
