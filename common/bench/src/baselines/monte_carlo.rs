//! Monte Carlo localization (the paper's [2]): particles all over the map are weighted by the scan,
//! resampled and scattered slightly, until they have converged. The robot stands still, so the same
//! scan is used repeatedly.

use engine::fit::{DistanceField, GridPose};
use engine::grid::{Cell, CellRules, GridFrame};
use engine::particles::Candidate;
use engine::space::Space;
use geometry::Pose;
use messages::UNKNOWN;

use super::Baseline;
use super::best::Estimate;
use super::particles::{Particle, ParticleFilter, Sensor, heaviest};
use super::reading::Readings;
use crate::worlds::World;

const MOST_UPDATES: u32 = 20;

/// Standard deviation at or below which particles have converged, in cells.
const GATHERED_CELLS: f64 = 3.0;

/// Scatter after the first update, in cells and radians; it decreases with each update.
const SCATTER_CELLS: f64 = 4.0;
const SCATTER_RADIANS: f64 = 0.03;

const MIN_SCATTER: f64 = 0.125;

/// Monte Carlo localization on a likelihood field, with fewer particles as they converge.
#[derive(Debug, Clone)]
pub struct MonteCarlo {
    space: Space,
    distance_field: DistanceField,
    sides: (usize, usize),
    sigma_cells: f64,
    /// Number of particles at the start of the last scan.
    pub started_with: usize,
}

impl MonteCarlo {
    /// Prepares a map for readings with one standard deviation, in cells.
    pub fn new(world: &World, space: &Space, sigma_cells: f64) -> Self {
        MonteCarlo {
            space: space.clone(),
            distance_field: distance_field(world, space.resolution_m),
            sides: (world.grid.width(), world.grid.height()),
            sigma_cells,
            started_with: 0,
        }
    }

    /// Starts around candidates in place of the whole map, at any heading; the filter is the same
    /// otherwise. The frame of the candidates is the grid's, in metres. `None` without candidates.
    pub fn locate_from(
        &mut self,
        readings: &Readings,
        candidates: &[Candidate],
    ) -> Option<Estimate> {
        let (field, sensor) = (&self.distance_field, self.sensor(readings));
        let filter = ParticleFilter::seeded(field, sensor, candidates.iter().copied())?;
        let (started_with, found) = self.gather(filter, false);
        self.started_with = started_with;
        found
    }

    /// Updates until the particles have converged; returns their first number, and the estimate.
    fn gather(
        &self,
        mut filter: ParticleFilter<'_>,
        heading_is_known: bool,
    ) -> (usize, Option<Estimate>) {
        let started_with = filter.particles.len();
        for update in 1..=MOST_UPDATES {
            filter.weigh();
            filter.resample();
            if spread_cells(&filter.particles) <= GATHERED_CELLS {
                break;
            }
            let scatter = (1.0 / f64::from(update)).max(MIN_SCATTER);
            // A known heading has no error.
            let turn = match heading_is_known {
                true => 0.0,
                false => SCATTER_RADIANS * scatter,
            };
            filter.scatter(SCATTER_CELLS * scatter, turn);
        }
        let on_the_grid = |(GridPose { x, y, heading }, share)| Estimate {
            x: (x as usize).min(self.sides.0 - 1),
            y: (y as usize).min(self.sides.1 - 1),
            heading: self.space.directions.nearest(heading).0,
            score: share as f32,
        };
        (started_with, heaviest(&filter.particles).map(on_the_grid))
    }

    fn sensor(&self, readings: &Readings) -> Sensor {
        let beams = readings.beams.iter().filter(|beam| beam.cells > 0.0);
        let spacing = self.space.directions.spacing();
        let beams = beams.map(|beam| (beam.bearing as f64 * spacing, beam.cells));
        Sensor::new(beams, self.sigma_cells)
    }
}

/// Distance field of the world. No beam ends inside an obstacle, so the inside counts as unknown.
fn distance_field(world: &World, resolution_m: f64) -> DistanceField {
    let (width, height) = (world.grid.width(), world.grid.height());
    let occupancy = |(&cell, is_boundary): (&Cell, bool)| match cell {
        _ if is_boundary => 100,
        Cell::Open => 0,
        _ => UNKNOWN,
    };
    let cells = world.grid.cells().iter().zip(world.is_boundary());
    let occupancy: Vec<u8> = cells.map(occupancy).collect();
    let frame = GridFrame {
        resolution_m,
        map_from_grid: Pose::IDENTITY,
    };
    DistanceField::new(frame, (width, height), &occupancy, CellRules::default())
        .expect("a world's grid is one of the engine's")
}

impl Baseline for MonteCarlo {
    fn locate(&mut self, readings: &Readings, headings: &[usize]) -> Option<Estimate> {
        if readings.beams.is_empty() {
            return None;
        }
        let spacing = self.space.directions.spacing();
        let headings: Vec<f64> = headings.iter().map(|&i| i as f64 * spacing).collect();
        let (field, sensor) = (&self.distance_field, self.sensor(readings));
        let filter = ParticleFilter::uniform(field, sensor, &headings)?;
        let (started_with, found) = self.gather(filter, headings.len() == 1);
        self.started_with = started_with;
        found
    }

    fn bytes(&self) -> usize {
        self.distance_field.bytes()
    }
}

/// Weighted standard deviation from the weighted mean, in cells.
fn spread_cells(particles: &[Particle]) -> f64 {
    let mean = |of: &dyn Fn(&Particle) -> f64| {
        let (sum, weight) = particles
            .iter()
            .fold((0.0, 0.0), |(sum, weight), particle| {
                let add = particle.weight * of(particle);
                (sum + add, weight + particle.weight)
            });
        sum / weight
    };
    let (x, y) = (mean(&|p| p.pose.x), mean(&|p| p.pose.y));
    mean(&|p| (p.pose.x - x).powi(2) + (p.pose.y - y).powi(2)).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_spread_counts_by_weight() {
        let particle = |x, weight| {
            let (y, heading) = (5.0, 0.0);
            let pose = GridPose { x, y, heading };
            Particle { pose, weight }
        };
        let even = [particle(0.0, 1.0), particle(4.0, 1.0)];
        assert_eq!(spread_cells(&even), 2.0);
        let gathered = [particle(0.0, 1.0), particle(4.0, 0.0)];
        assert_eq!(spread_cells(&gathered), 0.0);
    }
}
