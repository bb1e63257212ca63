//! Sufficient number of particles: KLD-sampling (Fox, "Adapting the Sample Size in Particle Filters
//! Through KLD-Sampling", International Journal of Robotics Research 22, 2003; Probabilistic
//! Robotics, section 8.3.7, table 8.4).
//!
//! With particles in k bins, the Kullback-Leibler distance between them and their distribution is
//! at most ε with probability 1 - δ if there are χ²(k - 1, 1 - δ) / 2ε of them.

use std::collections::HashSet;
use std::f64::consts::TAU;

use engine::fit::GridPose;

/// Side of a bin in cells, and bins per turn, of three degrees each: a particle must be this close to
/// the true pose to outweigh the others.
const BIN_CELLS: f64 = 5.0;
pub(super) const HEADINGS: i32 = 120;

/// Error ε, which yields as many particles as there are bins, and their minimum number.
const ERROR: f64 = 0.32;
const MIN: usize = 2000;

/// Standard normal quantile of 1 - δ = 99 %.
const QUANTILE: f64 = 2.326_347_874;

/// Number of particles (table 8.4, line 16), with the χ² quantile of Wilson and Hilferty.
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

impl Bin {
    pub(super) fn of(pose: GridPose) -> Self {
        let heading = (pose.heading.rem_euclid(TAU) * (f64::from(HEADINGS) / TAU)) as i32;
        let along = |cells: f64| (cells * (1.0 / BIN_CELLS)).floor() as i32;
        Bin {
            x: along(pose.x),
            y: along(pose.y),
            // An angle just below zero may be rounded to a full turn.
            heading: heading.min(HEADINGS - 1),
        }
    }
}

/// Counts occupied bins, and the number of particles that they require.
pub(super) struct Enough {
    bins: HashSet<Bin>,
    /// Sufficient number of particles for the bins so far.
    pub(super) number: usize,
}

impl Default for Enough {
    fn default() -> Self {
        Enough {
            bins: HashSet::new(),
            number: MIN,
        }
    }
}

impl Enough {
    pub(super) fn add(&mut self, pose: GridPose) {
        if self.bins.insert(Bin::of(pose)) {
            self.number = MIN.max(number_for(self.bins.len(), ERROR) as usize);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_number_is_the_quantile_of_the_chi_squared_distribution() {
        // 99 % quantiles for 1, 9, 30 and 100 degrees of freedom, from tables.
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
        let bin = |x, y, degrees: f64| {
            let heading = degrees.to_radians();
            let Bin { x, y, heading } = Bin::of(GridPose { x, y, heading });
            (x, y, heading)
        };
        assert_eq!(bin(0.0, 4.9, 0.0), (0, 0, 0));
        assert_eq!(bin(-0.1, 5.1, -1.0), (-1, 1, 119));
        assert_eq!(bin(12.0, 26.0, 364.0), (2, 5, 1));
        assert_eq!(bin(0.0, 0.0, -1e-15).2, 119);
    }
}
