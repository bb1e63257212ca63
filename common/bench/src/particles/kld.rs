//! Sufficient number of particles: KLD-sampling (Fox, "Adapting the Sample Size in Particle Filters
//! Through KLD-Sampling", International Journal of Robotics Research 22, 2003; Probabilistic
//! Robotics, section 8.3.7, table 8.4).
//!
//! With particles in k bins, the Kullback-Leibler distance between them and their distribution is
//! at most ε with probability 1 - δ if there are χ²(k - 1, 1 - δ) / 2ε of them.

use std::collections::HashSet;
use std::f64::consts::TAU;
use std::hash::{BuildHasherDefault, DefaultHasher};

use super::ParticlesConfig;
use engine::fit::GridPose;

/// Standard normal quantile of 1 - δ = 99 %.
const QUANTILE: f64 = 2.326_347_874;

/// Number of particles for this many bins, at an error of ε. The χ² quantile is the approximation
/// of Wilson and Hilferty (table 8.4, line 16).
fn number_for(bins: usize, error: f64) -> f64 {
    if bins < 2 {
        return 1.0;
    }
    let freedoms = (bins - 1) as f64;
    let share = 2.0 / (9.0 * freedoms);
    let root = 1.0 - share + share.sqrt() * QUANTILE;
    (freedoms / (2.0 * error) * root.powi(3)).ceil()
}

/// Index of a bin of poses along each axis; in sorted order, neighbours at a heading are adjacent.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(super) struct Bin {
    pub(super) heading: i32,
    pub(super) y: i32,
    pub(super) x: i32,
}

/// Division of the poses of a grid into bins.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Binning {
    per_cell: f64,
    per_radian: f64,
    /// Bins per turn.
    pub(super) headings: i32,
}

impl Binning {
    pub(super) fn new(config: &ParticlesConfig, resolution_m: f64) -> Self {
        let headings = (360.0 / config.particles_bin_deg).round().max(1.0);
        Binning {
            per_cell: resolution_m / config.particles_bin_m,
            per_radian: headings / TAU,
            headings: headings as i32,
        }
    }

    pub(super) fn bin(&self, pose: GridPose) -> Bin {
        let heading = (pose.heading.rem_euclid(TAU) * self.per_radian) as i32;
        Bin {
            x: (pose.x * self.per_cell).floor() as i32,
            y: (pose.y * self.per_cell).floor() as i32,
            // An angle just below zero may be rounded to a full turn.
            heading: heading.min(self.headings - 1),
        }
    }
}

/// Counts occupied bins, and the number of particles that they require. Hashes have no random key,
/// so runs are reproducible.
#[derive(Debug, Clone)]
pub(super) struct Enough {
    binning: Binning,
    bins: HashSet<Bin, BuildHasherDefault<DefaultHasher>>,
    error: f64,
    min: usize,
    max: usize,
    number: usize,
}

impl Enough {
    pub(super) fn new(config: &ParticlesConfig, binning: Binning) -> Self {
        let min = config.particles_min.max(1) as usize;
        Enough {
            binning,
            bins: HashSet::default(),
            error: config.particles_error,
            min,
            max: min.max(config.particles_max as usize),
            number: min,
        }
    }

    pub(super) fn clear(&mut self) {
        self.bins.clear();
        self.number = self.min;
    }

    pub(super) fn add(&mut self, pose: GridPose) {
        if self.bins.insert(self.binning.bin(pose)) {
            let number = number_for(self.bins.len(), self.error) as usize;
            self.number = number.clamp(self.min, self.max);
        }
    }

    /// Sufficient number of particles for the bins so far.
    pub(super) fn number(&self) -> usize {
        self.number
    }

    /// The sufficient number or, if larger and allowed, this number.
    pub(super) fn at_least(&self, number: usize) -> usize {
        self.number.max(number.min(self.max))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_number_is_the_quantile_of_the_chi_squared_distribution() {
        // 99 % quantiles for 1, 9, 30 and 100 degrees of freedom, from tables; Wilson and
        // Hilferty's approximation has this accuracy.
        for (bins, quantile) in [(2, 6.635), (10, 21.666), (31, 50.892), (101, 135.807)] {
            let number = number_for(bins, 0.05);
            let off = number / (quantile / 0.1) - 1.0;
            assert!(off.abs() < 0.01, "{bins} bins: {number}");
        }
        assert_eq!((number_for(0, 0.05), number_for(1, 0.05)), (1.0, 1.0));
        // Computed by hand from the formula: 45 · (1 - 2/81 + 2.3263 · √(2/81))³.
        assert_eq!(number_for(10, 0.1), 109.0);
    }

    #[test]
    fn bins_wrap_at_a_turn_and_go_on_below_zero() {
        let binning = Binning::new(&ParticlesConfig::default(), 0.1);
        let bin = |x, y, degrees: f64| {
            let heading = degrees.to_radians();
            let Bin { x, y, heading } = binning.bin(GridPose { x, y, heading });
            (x, y, heading)
        };
        assert_eq!(bin(0.0, 4.9, 0.0), (0, 0, 0));
        assert_eq!(bin(-0.1, 5.1, -1.0), (-1, 1, 35));
        assert_eq!(bin(12.0, 26.0, 365.0), (2, 5, 0));
        assert_eq!(bin(0.0, 0.0, -1e-15).2, 35);
    }

    #[test]
    fn the_number_stays_within_its_limits() {
        let config = ParticlesConfig {
            particles_min: 100,
            particles_max: 300,
            ..ParticlesConfig::default()
        };
        let mut enough = Enough::new(&config, Binning::new(&config, 0.5));
        let at = |x| GridPose {
            x,
            y: 0.0,
            heading: 0.0,
        };
        let mut numbers = Vec::new();
        for x in 0..40 {
            enough.add(at(f64::from(x)));
            enough.add(at(f64::from(x)));
            numbers.push(enough.number());
        }
        assert_eq!((numbers[0], numbers[39]), (100, 300));
        assert_eq!(numbers[9] as f64, number_for(10, 0.05));
        enough.clear();
        assert_eq!(enough.number(), 100);
    }
}
