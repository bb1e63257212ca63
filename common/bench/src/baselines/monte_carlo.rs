//! Monte Carlo localization (the paper's [2]): particles all over the map are weighted by the scan,
//! resampled and scattered slightly, until they have converged. The robot stands still, so the same
//! scan is used repeatedly.

use engine::fit::{DistanceField, GridPose};
use engine::grid::{Cell, CellRules, GridFrame};
use engine::particles::Candidate;
use engine::space::Space;
use geometry::Pose;
use messages::{Reading, UNKNOWN};

use super::Baseline;
use super::best::Estimate;
use super::reading::Readings;
use crate::particles::{
    Estimate as Gathering, Particle, ParticleFilter, ParticlesConfig, StartHeadings,
};
use crate::worlds::World;

/// Settings of the particles and their updates.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MonteCarloConfig {
    /// Settings of the filter. The standard deviation is replaced by that of the readings.
    pub particles: ParticlesConfig,
    /// Maximum number of updates by the scan.
    pub most_updates: usize,
}

impl Default for MonteCarloConfig {
    /// One particle for each bin of 5 × 5 cells and three degrees at the start: a particle must be
    /// this close to the true pose to outweigh the others. The error of 0.32 yields as many
    /// particles as there are bins.
    fn default() -> Self {
        MonteCarloConfig {
            particles: ParticlesConfig {
                particles_min: 2000,
                particles_max: u32::MAX,
                particles_error: 0.32,
                particles_bin_m: 5.0 * crate::RESOLUTION_M,
                particles_bin_deg: 3.0,
                // All beams, as in the other methods.
                particles_beams: u32::MAX,
                ..ParticlesConfig::default()
            },
            most_updates: 20,
        }
    }
}

/// Standard deviation at or below which particles have converged, in cells.
const GATHERED_CELLS: f64 = 3.0;

/// Scatter of the particles after the first update, in cells and radians; it decreases with each
/// update.
const SCATTER_CELLS: f64 = 4.0;
const SCATTER_RADIANS: f64 = 0.03;

/// Smallest factor of the scatter.
const MIN_SCATTER: f64 = 0.125;

/// Monte Carlo localization on a likelihood field; the number of particles decreases as they
/// converge.
#[derive(Debug, Clone)]
pub struct MonteCarlo {
    space: Space,
    distance_field: DistanceField,
    sides: (usize, usize),
    config: MonteCarloConfig,
    /// Number of particles at the start of the last scan.
    started_with: usize,
}

impl MonteCarlo {
    /// Prepares a map for readings with one standard deviation, in cells.
    ///
    /// # Panics
    /// The world has no cells, which [`World::generate`] never returns.
    #[must_use]
    pub fn new(world: &World, space: &Space, sigma_cells: f64, config: MonteCarloConfig) -> Self {
        let particles = ParticlesConfig {
            particles_sigma_m: sigma_cells * space.resolution_m,
            ..config.particles
        };
        MonteCarlo {
            space: space.clone(),
            distance_field: distance_field(world, space.resolution_m),
            sides: (world.grid.width(), world.grid.height()),
            config: MonteCarloConfig {
                particles,
                ..config
            },
            started_with: 0,
        }
    }

    /// Number of particles at the start of the last scan.
    #[must_use]
    pub fn started_with(&self) -> usize {
        self.started_with
    }

    /// Starts around candidates in place of the whole map, at any heading; the filter is the same
    /// otherwise. The frame of the candidates is the grid's, in metres. `None` without readings or
    /// candidates.
    #[must_use]
    pub fn locate_from(
        &mut self,
        readings: &Readings,
        candidates: &[Candidate],
    ) -> Option<Estimate> {
        let readings = self.beams(readings);
        let (frame, config) = (self.distance_field.frame, self.config.particles);
        let filter = ParticleFilter::seeded(frame, candidates.iter().copied(), config).ok()?;
        self.gather(&readings, filter, false)
    }

    /// Updates the filter until the particles have converged; returns its estimate.
    fn gather(
        &mut self,
        readings: &[Reading],
        mut filter: ParticleFilter,
        heading_is_known: bool,
    ) -> Option<Estimate> {
        self.started_with = filter.particles().len();
        for update in 1..=self.config.most_updates {
            filter.weigh(&self.distance_field, readings);
            filter.resample();
            if spread_cells(filter.particles()) <= GATHERED_CELLS {
                break;
            }
            let scatter = (1.0 / update as f64).max(MIN_SCATTER);
            // A known heading has no error.
            let turn = match heading_is_known {
                true => 0.0,
                false => SCATTER_RADIANS * scatter,
            };
            filter.scatter(SCATTER_CELLS * scatter * self.space.resolution_m, turn);
        }
        filter.estimate().map(|found| self.on_the_grid(&found))
    }

    fn on_the_grid(&self, found: &Gathering) -> Estimate {
        let GridPose { x, y, heading } =
            GridPose::of(self.distance_field.frame, found.map_from_target);
        Estimate {
            x: (x as usize).min(self.sides.0 - 1),
            y: (y as usize).min(self.sides.1 - 1),
            heading: self.space.directions.nearest(heading).0,
            score: found.share as f32,
        }
    }

    /// Converts the readings with a return.
    fn beams(&self, readings: &Readings) -> Vec<Reading> {
        let beams = readings.beams.iter().filter(|beam| beam.cells > 0.0);
        let reading = beams.map(|beam| Reading {
            bearing: beam.bearing as f64 * self.space.directions.spacing(),
            range_m: beam.cells * self.space.resolution_m,
            weight: 1.0,
            ..Reading::default()
        });
        reading.collect()
    }
}

/// Distance field of the world. No beam ends inside an obstacle, so the inside counts as unknown.
fn distance_field(world: &World, resolution_m: f64) -> DistanceField {
    let (width, height) = (world.grid.width(), world.grid.height());
    let inner = |&cell: &Cell| if cell == Cell::Open { 0 } else { UNKNOWN };
    let mut occupancy: Vec<u8> = world.grid.cells().iter().map(inner).collect();
    for cell in &world.boundary {
        occupancy[usize::from(cell.y) * width + usize::from(cell.x)] = 100;
    }
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
        let readings = self.beams(readings);
        let (start, config) = (StartHeadings::OneOf(&headings), self.config.particles);
        let filter = ParticleFilter::uniform(&self.distance_field, start, config).ok()?;
        self.gather(&readings, filter, headings.len() == 1)
    }

    fn bytes(&self) -> usize {
        self.distance_field.bytes()
    }
}

/// Weighted standard deviation from the weighted mean, in cells.
fn spread_cells(particles: &[Particle]) -> f64 {
    let mean = |of: &dyn Fn(&Particle) -> f64| {
        let add = |(sum, weight), particle: &Particle| {
            (
                sum + particle.weight * of(particle),
                weight + particle.weight,
            )
        };
        let (sum, weight) = particles.iter().fold((0.0, 0.0), add);
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
