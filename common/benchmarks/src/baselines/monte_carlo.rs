//! Monte Carlo localization (the paper's [2]): particles all over the map are
//! weighted by the scan, drawn anew by their weights and scattered a little,
//! until they have gathered.

use engine::space::Space;
use rand::rngs::Xoshiro256PlusPlus;
use rand::{RngExt, SeedableRng};
use rand_distr::{Distribution, StandardNormal};

use super::Baseline;
use super::best::Estimate;
use super::field_correlation::{FULL, likelihood};
use super::reading::Readings;
use crate::worlds::World;

/// How many particles there are, and for how long.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MonteCarloConfig {
    /// Cells for each particle at the start, at a known heading.
    pub cells_per_particle: f64,
    /// Headings at which particles start in each cell, if it is unknown.
    pub start_headings: f64,
    /// Fewest particles; their number falls to this as they gather.
    pub least_particles: usize,
    /// Most updates by the scan.
    pub most_updates: usize,
    /// Beams that count as independent: weights are tempered to that many.
    pub independent_beams: f64,
    /// Where the random numbers begin.
    pub seed: u64,
}

impl Default for MonteCarloConfig {
    fn default() -> Self {
        MonteCarloConfig {
            cells_per_particle: 25.0,
            start_headings: 120.0,
            least_particles: 2000,
            most_updates: 20,
            independent_beams: 16.0,
            seed: 1,
        }
    }
}

/// Share of readings that anything may explain.
const RANDOM_SHARE: f32 = 0.05;

/// Particles within this many cells of their mean have gathered.
const GATHERED_CELLS: f32 = 3.0;

/// Monte Carlo localization on a likelihood field, with particles that become
/// fewer as they gather.
#[derive(Debug, Clone)]
pub struct MonteCarlo {
    space: Space,
    width: usize,
    height: usize,
    field: Vec<u8>,
    /// Free cells, where particles start.
    free: Vec<u32>,
    config: MonteCarloConfig,
    /// Updates of the last scan, and particles that were weighted in all.
    effort: (usize, usize),
}

/// A pose, in cells and radians, and its weight.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Particle {
    x: f32,
    y: f32,
    heading: f32,
    weight: f32,
}

impl MonteCarlo {
    /// Prepares a map for readings with one deviation, in cells.
    #[must_use]
    pub fn new(world: &World, space: &Space, sigma_cells: f64, config: MonteCarloConfig) -> Self {
        let grid = &world.grid;
        let width = grid.width();
        let is_open = |i: &u32| {
            let i = *i as usize;
            grid.is_open((i % width) as i64, (i / width) as i64)
        };
        MonteCarlo {
            space: space.clone(),
            width,
            height: grid.height(),
            field: likelihood(world, sigma_cells),
            free: (0..grid.cells().len() as u32).filter(is_open).collect(),
            config,
            effort: (0, 0),
        }
    }

    /// Updates that the last scan took, and particles that were weighted in
    /// all of them.
    #[must_use]
    pub fn effort(&self) -> (usize, usize) {
        self.effort
    }

    /// Particles at random free cells and headings.
    fn start(&self, headings: &[usize], rng: &mut Xoshiro256PlusPlus) -> Vec<Particle> {
        let share = headings.len() as f64 / self.space.directions.count() as f64;
        let turns = (self.config.start_headings * share).max(1.0);
        let count = self.free.len() as f64 / self.config.cells_per_particle * turns;
        let spacing = self.space.directions.spacing() as f32;
        let particle = |_| {
            let cell = self.free[rng.random_range(0..self.free.len())] as usize;
            let heading = headings[rng.random_range(0..headings.len())];
            Particle {
                x: (cell % self.width) as f32,
                y: (cell / self.width) as f32,
                heading: heading as f32 * spacing,
                weight: 1.0,
            }
        };
        let count = (count as usize).max(self.config.least_particles);
        (0..count).map(particle).collect()
    }

    /// Weights each particle by where its beams would end.
    fn weigh(&self, particles: &mut [Particle], beams: &[(f32, f32)]) {
        let temper = (self.config.independent_beams / beams.len() as f64).min(1.0) as f32;
        let log: Vec<f32> = (0..=FULL)
            .map(|level| {
                let hit = f32::from(level) / f32::from(FULL);
                temper * (RANDOM_SHARE + (1.0 - RANDOM_SHARE) * hit).ln()
            })
            .collect();
        for particle in &mut *particles {
            let (sin, cos) = particle.heading.sin_cos();
            let logs = beams.iter().map(|&(ahead, left)| {
                let x = particle.x + cos * ahead - sin * left;
                let y = particle.y + sin * ahead + cos * left;
                log[usize::from(self.level(x, y))]
            });
            particle.weight = logs.sum();
        }
        let most = particles
            .iter()
            .map(|particle| particle.weight)
            .fold(f32::MIN, f32::max);
        for particle in particles {
            particle.weight = (particle.weight - most).exp();
        }
    }

    /// The field at a place in cells; zero off the map.
    #[inline]
    fn level(&self, x: f32, y: f32) -> u8 {
        let (x, y) = ((x + 0.5).floor() as i32, (y + 0.5).floor() as i32);
        let is_within = (x as u32) < self.width as u32 && (y as u32) < self.height as u32;
        if is_within {
            self.field[y as usize * self.width + x as usize]
        } else {
            0
        }
    }

    fn cell(&self, particle: &Particle) -> (usize, usize) {
        let to_cell = |at: f32, side: usize| (at.round().max(0.0) as usize).min(side - 1);
        (
            to_cell(particle.x, self.width),
            to_cell(particle.y, self.height),
        )
    }
}

impl Baseline for MonteCarlo {
    fn locate(&mut self, readings: &Readings, headings: &[usize]) -> Option<Estimate> {
        if self.free.is_empty() || headings.is_empty() || readings.beams.is_empty() {
            return None;
        }
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(self.config.seed);
        let beams: Vec<(f32, f32)> = (readings.beams.iter())
            .map(|reading| {
                let (sin, cos) =
                    (reading.bearing as f64 * self.space.directions.spacing()).sin_cos();
                ((reading.cells * cos) as f32, (reading.cells * sin) as f32)
            })
            .collect();
        let turn_rad = if headings.len() > 1 { 0.03 } else { 0.0 };
        let mut particles = self.start(headings, &mut rng);
        self.effort = (0, 0);
        for update in 1..=self.config.most_updates {
            self.weigh(&mut particles, &beams);
            self.effort = (update, self.effort.1 + particles.len());
            if spread_cells(&particles) <= GATHERED_CELLS {
                break;
            }
            // The scatter shrinks as the particles gather.
            let scatter = (4.0 / update as f32).max(0.5);
            let count = (particles.len() / 4).max(self.config.least_particles);
            particles = draw(&particles, count, &mut rng);
            for particle in &mut particles {
                let mut normal = || -> f32 { StandardNormal.sample(&mut rng) };
                particle.x += scatter * normal();
                particle.y += scatter * normal();
                particle.heading += turn_rad * scatter / 4.0 * normal();
            }
        }
        let best = particles
            .iter()
            .max_by(|a, b| a.weight.total_cmp(&b.weight))?;
        let (x, y) = self.cell(best);
        let (heading, _) = self.space.directions.nearest(f64::from(best.heading));
        Some(Estimate {
            x,
            y,
            heading,
            score: best.weight,
        })
    }

    fn bytes(&self) -> usize {
        self.field.len() + size_of_val(&self.free[..])
    }
}

/// Weighted deviation from the weighted mean, in cells.
fn spread_cells(particles: &[Particle]) -> f32 {
    let mean = |of: &dyn Fn(&Particle) -> f32| {
        let (sum, weight) = particles
            .iter()
            .fold((0.0f64, 0.0f64), |(sum, weight), particle| {
                let share = f64::from(particle.weight);
                (sum + share * f64::from(of(particle)), weight + share)
            });
        (sum / weight) as f32
    };
    let (x, y) = (mean(&|particle| particle.x), mean(&|particle| particle.y));
    mean(&|particle| (particle.x - x).powi(2) + (particle.y - y).powi(2)).sqrt()
}

/// Draws particles by their weights, with one random number for all: each is
/// taken as often as its weight says, to within one.
fn draw(particles: &[Particle], count: usize, rng: &mut Xoshiro256PlusPlus) -> Vec<Particle> {
    let total: f64 = particles
        .iter()
        .map(|particle| f64::from(particle.weight))
        .sum();
    let step = total / count as f64;
    let mut next = rng.random_range(0.0..1.0) * step;
    let mut drawn = Vec::with_capacity(count + 1);
    let mut sum = 0.0;
    for particle in particles {
        sum += f64::from(particle.weight);
        while next < sum {
            drawn.push(*particle);
            next += step;
        }
    }
    drawn
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn particles_are_drawn_as_often_as_they_weigh() {
        let particle = |x, weight| Particle {
            x,
            y: 0.0,
            heading: 0.0,
            weight,
        };
        let particles = [particle(0.0, 1.0), particle(1.0, 0.0), particle(2.0, 3.0)];
        let drawn = draw(&particles, 400, &mut Xoshiro256PlusPlus::seed_from_u64(1));
        let of = |x: f32| drawn.iter().filter(|particle| particle.x == x).count();
        assert!(of(0.0).abs_diff(100) <= 1 && of(2.0).abs_diff(300) <= 1);
        assert_eq!(of(1.0), 0);
    }

    #[test]
    fn the_spread_counts_by_weight() {
        let particle = |x, weight| Particle {
            x,
            y: 5.0,
            heading: 0.0,
            weight,
        };
        let even = [particle(0.0, 1.0), particle(4.0, 1.0)];
        assert_eq!(spread_cells(&even), 2.0);
        let gathered = [particle(0.0, 1.0), particle(4.0, 0.0)];
        assert_eq!(spread_cells(&gathered), 0.0);
    }
}
