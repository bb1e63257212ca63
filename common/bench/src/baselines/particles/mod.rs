//! Particle filter of a robot that stands still: the pose as a set of weighted particles, which are
//! weighted by a scan, resampled and scattered.
//!
//! Dellaert, Fox, Burgard and Thrun, "Monte Carlo Localization for Mobile Robots" (ICRA 1999);
//! Thrun, Burgard and Fox, "Probabilistic Robotics" (2005), chapter 8. Particles are in cells of the
//! grid. The filter is deterministic: the same calls give bit-identical particles on one machine. It
//! does not detect that it is lost: no random particles are added (unlike in table 8.3 of the book).

mod clusters;
mod kld;
mod sensor;

use engine::fit::{DistanceField, GridPose};
use engine::particles::{Candidate, Rng, Seeds};
use geometry::wrap_angle;
use rand::{RngExt, SeedableRng};
use rand_distr::{Distribution, StandardNormal};

pub(super) use clusters::heaviest;
use kld::{Bin, Enough};
pub(super) use sensor::Sensor;

/// Particles are resampled if their effective number falls below this share: each resampling loses
/// some information. Half is usual (for instance Grisetti, Stachniss and Burgard, "Improved
/// Techniques for Grid Mapping", IEEE Transactions on Robotics 23, 2007, section III).
const RESAMPLE_BELOW: f64 = 0.5;

const SEED: u64 = 1;

#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Particle {
    pub(super) pose: GridPose,
    /// Relative likelihood; the weights have a positive sum, which need not be 1.
    pub(super) weight: f64,
}

/// A particle filter on one map, for one scan.
pub(super) struct ParticleFilter<'a> {
    distance_field: &'a DistanceField,
    sensor: Sensor,
    rng: Rng,
    pub(super) particles: Vec<Particle>,
}

impl<'a> ParticleFilter<'a> {
    /// Starts with particles uniform over the free cells of a map, each at one of these headings in
    /// radians. `None` without a free cell or a heading.
    pub(super) fn uniform(
        distance_field: &'a DistanceField,
        sensor: Sensor,
        headings: &[f64],
    ) -> Option<Self> {
        let free: Vec<usize> = distance_field.free_cells().collect();
        let width = distance_field.width();
        let draw = |rng: &mut Rng| {
            let cell = one_of(&free, rng);
            let (within_x, within_y): (f64, f64) = (rng.random(), rng.random());
            GridPose {
                x: (cell % width) as f64 + within_x,
                y: (cell / width) as f64 + within_y,
                heading: wrap_angle(one_of(headings, rng)),
            }
        };
        let can_start = !free.is_empty() && !headings.is_empty();
        can_start.then(|| Self::start(distance_field, sensor, draw))
    }

    /// Starts with particles around candidates; `None` without one of finite numbers.
    pub(super) fn seeded(
        distance_field: &'a DistanceField,
        sensor: Sensor,
        candidates: impl IntoIterator<Item = Candidate>,
    ) -> Option<Self> {
        let seeds = Seeds::new(distance_field.frame, candidates).ok()?;
        Some(Self::start(distance_field, sensor, |rng| seeds.draw(rng)))
    }

    /// Draws particles until their number is sufficient (Probabilistic Robotics, table 8.4).
    fn start(
        distance_field: &'a DistanceField,
        sensor: Sensor,
        draw: impl Fn(&mut Rng) -> GridPose,
    ) -> Self {
        let (mut rng, mut enough) = (Rng::seed_from_u64(SEED), Enough::default());
        let mut particles = Vec::new();
        while particles.len() < enough.number {
            let pose = draw(&mut rng);
            enough.add(pose);
            particles.push(Particle { pose, weight: 1.0 });
        }
        // Sorting puts neighbours next to each other: they read nearby cells, and systematic
        // resampling draws each neighbourhood by its weight.
        particles.sort_by_cached_key(|particle| Bin::of(particle.pose));
        ParticleFilter {
            distance_field,
            sensor,
            rng,
            particles,
        }
    }

    /// Moves each particle by a normal error: of x and y in cells, and of the heading in radians.
    pub(super) fn scatter(&mut self, cells: f64, turn: f64) {
        for particle in &mut self.particles {
            let mut error = || -> f64 { StandardNormal.sample(&mut self.rng) };
            let (ahead, left, turned) = (cells * error(), cells * error(), turn * error());
            let GridPose { x, y, heading } = particle.pose;
            let (sin, cos) = heading.sin_cos();
            particle.pose = GridPose {
                x: x + cos * ahead - sin * left,
                y: y + sin * ahead + cos * left,
                heading: wrap_angle(heading + turned),
            };
        }
    }

    /// Multiplies the weights by the likelihood of the scan.
    pub(super) fn weigh(&mut self) {
        let mut most = f64::NEG_INFINITY;
        for particle in &mut self.particles {
            let scan = (self.sensor).log_likelihood(self.distance_field, particle.pose);
            particle.weight = particle.weight.ln() + scan;
            most = most.max(particle.weight);
        }
        for particle in &mut self.particles {
            particle.weight = (particle.weight - most).exp();
        }
    }

    /// Resamples if the effective number of particles is less than half.
    pub(super) fn resample(&mut self) {
        let weights = || self.particles.iter().map(|particle| particle.weight);
        if effective_number(weights()) >= RESAMPLE_BELOW * self.particles.len() as f64 {
            return;
        }
        let total: f64 = weights().sum();
        let offset = self.rng.random();
        let number = self.number(total, offset);
        let copies = copies(&self.particles, total, number, offset);
        let drawn = copies.flat_map(|(particle, copies)| {
            let pose = particle.pose;
            std::iter::repeat_n(Particle { pose, weight: 1.0 }, copies)
        });
        self.particles = drawn.collect();
    }

    /// Number of particles to draw: sufficient for the bins of that many. Unlike in KLD-sampling,
    /// drawing is systematic, so the number must be known in advance: it starts at the minimum and
    /// grows as the bins require, by at least a quarter, which keeps the passes few and the number
    /// at most that much too large.
    fn number(&self, total: f64, offset: f64) -> usize {
        let (mut enough, mut number) = (Enough::default(), 0);
        while number < enough.number {
            number = enough.number.max(number + number / 4);
            for (particle, copies) in copies(&self.particles, total, number, offset) {
                if copies > 0 {
                    enough.add(particle.pose);
                }
            }
        }
        number
    }
}

fn one_of<T: Copy>(items: &[T], rng: &mut Rng) -> T {
    items[rng.random_range(0..items.len() as u64) as usize]
}

/// Each particle with the number of its copies among `number` systematic (low variance) draws
/// (Probabilistic Robotics, table 4.4): within one of its share. `total` is the sum of the weights
/// in their order; `offset` is in `0..1`.
fn copies(
    particles: &[Particle],
    total: f64,
    number: usize,
    offset: f64,
) -> impl Iterator<Item = (&Particle, usize)> {
    let scale = number as f64 / total;
    let (mut sum, mut drawn) = (0.0, 0);
    particles.iter().map(move |particle| {
        sum += particle.weight;
        // Draws at offset, offset + 1, … below the sum.
        let below = (sum * scale - offset).ceil().max(0.0) as usize;
        (particle, below - std::mem::replace(&mut drawn, below))
    })
}

/// Kish's effective sample size, (Σ w)² / Σ w²: number of equally weighted particles with the same
/// information (Liu, "Metropolized independent sampling", 1996, for particles).
fn effective_number(weights: impl Iterator<Item = f64>) -> f64 {
    let (sum, squares) = weights.fold((0.0, 0.0), |(sum, squares), weight| {
        (sum + weight, squares + weight * weight)
    });
    sum * sum / squares.max(f64::MIN_POSITIVE)
}

#[cfg(test)]
pub(super) mod tests {
    use engine::grid::{CellRules, GridFrame};
    use geometry::{Covariance, Pose};
    use messages::UNKNOWN;
    use proptest::collection::vec;
    use proptest::prelude::*;

    use super::*;

    /// Returns the distance field of a drawing, whose last line is the lowest row of cells of 0.1 m:
    /// `#` is occupied, `?` unknown, other characters free.
    pub(super) fn distance_field(rows: &[&str]) -> DistanceField {
        let cell = |cell| match cell {
            b'#' => 100,
            b'?' => UNKNOWN,
            _ => 0,
        };
        let from_below = rows.iter().rev().flat_map(|row| row.bytes());
        let occupancy: Vec<u8> = from_below.map(cell).collect();
        let frame = GridFrame::new(0.1, Pose::IDENTITY);
        let sides = (rows[0].len(), rows.len());
        DistanceField::new(frame, sides, &occupancy, CellRules::default()).unwrap()
    }

    fn particle(weight: f64) -> Particle {
        let (x, y, heading) = (0.0, 0.0, 0.0);
        let pose = GridPose { x, y, heading };
        Particle { pose, weight }
    }

    #[test]
    fn particles_start_in_every_free_cell_and_in_no_other() {
        let field = distance_field(&["#.?", "..#"]);
        let start =
            |headings: &[f64]| ParticleFilter::uniform(&field, Sensor::new([], 1.0), headings);
        let particles = start(&[1.0, 4.0]).unwrap().particles;
        let mut counts = [0; 6];
        for Particle { pose, .. } in &particles {
            counts[pose.y as usize * 3 + pose.x as usize] += 1;
            assert!(pose.heading == 1.0 || pose.heading == wrap_angle(4.0));
        }
        // Within five standard deviations.
        let (each, deviation) = (
            particles.len() as f64 / 3.0,
            (particles.len() as f64 * 2.0 / 9.0).sqrt(),
        );
        for (cell, count) in counts.into_iter().enumerate() {
            let expected = if [0, 1, 4].contains(&cell) { each } else { 0.0 };
            assert!(
                (f64::from(count) - expected).abs() <= 5.0 * deviation,
                "{counts:?}"
            );
        }
        assert!(start(&[]).is_none());
        let full = distance_field(&["#?"]);
        assert!(ParticleFilter::uniform(&full, Sensor::new([], 1.0), &[0.0]).is_none());
    }

    #[test]
    fn scatter_has_the_deviations_that_are_asked_for_and_even_weights_are_not_drawn_again() {
        let field = distance_field(&["....", "...."]);
        let candidate = Candidate {
            map_from_target: Pose::new(0.2, 0.1, 0.4),
            covariance: Covariance::from_deviations(0.05, 0.05, 0.02),
            weight: 1.0,
        };
        let start = || ParticleFilter::seeded(&field, Sensor::new([], 1.0), [candidate]).unwrap();
        let mut filter = start();
        filter.resample();
        filter.weigh();
        assert_eq!(filter.particles, start().particles, "nothing was seen");
        let before = filter.particles.clone();
        filter.scatter(2.0, 0.0);
        let pairs = || before.iter().zip(&filter.particles);
        assert!(pairs().all(|(a, b)| a.pose.heading == b.pose.heading));
        for of in [|p: &GridPose| p.x, |p: &GridPose| p.y] {
            let squares = pairs().map(|(a, b)| (of(&b.pose) - of(&a.pose)).powi(2));
            let deviation = (squares.sum::<f64>() / before.len() as f64).sqrt();
            // Within six standard errors of 1 / √(2 · 2000) of it.
            assert!((deviation - 2.0).abs() < 0.19, "{deviation}");
        }
        assert!(ParticleFilter::seeded(&field, Sensor::new([], 1.0), []).is_none());
    }

    proptest! {
        #[test]
        fn each_is_drawn_within_one_of_its_share(
            weights in vec(prop_oneof![0.0..1.0f64, Just(0.0)], 1..50),
            number in 1usize..2000, offset in 0.0..1.0f64,
        ) {
            let total: f64 = weights.iter().sum();
            prop_assume!(total > 0.0);
            let particles: Vec<Particle> = weights.into_iter().map(particle).collect();
            let drawn = || copies(&particles, total, number, offset);
            prop_assert_eq!(drawn().map(|(_, copies)| copies).sum::<usize>(), number);
            for (particle, copies) in drawn() {
                let share = number as f64 * particle.weight / total;
                // The sums round.
                prop_assert!((copies as f64 - share).abs() < 1.0 + 1e-9);
            }
        }
    }

    #[test]
    fn the_effective_number_counts_equal_weights() {
        let effective = |weights: &[f64]| effective_number(weights.iter().copied());
        assert_eq!(effective(&[0.25; 5]), 5.0);
        assert_eq!(effective(&[3.0, 0.0, 0.0]), 1.0);
        assert_eq!(effective(&[2.0, 1.0, 1.0]), 16.0 / 6.0);
        assert_eq!(effective(&[]), 0.0);
    }
}
