//! Numbers of steps for which the bins of distances stand.

use super::bins::Bins;
use crate::directions::Directions;

/// Start of each bin in steps, by class of directions.
#[derive(Debug, Clone)]
pub(crate) struct BinSteps {
    /// Fewest steps in each bin or a later one, 256 for each class.
    firsts: Vec<u16>,
    /// Bin of each number of steps up to the longest ray, class by class.
    bins: Vec<u8>,
    longest: u16,
}

const BINS: usize = 256;

impl BinSteps {
    /// Makes the tables for rays of up to `longest` steps.
    pub(crate) fn new(bins: &Bins, directions: &Directions, longest: u16) -> Self {
        let mut firsts = Vec::with_capacity(BINS * directions.classes());
        let mut table = Vec::new();
        for class in 0..directions.classes() {
            let start = firsts.len();
            for steps in 0..=longest {
                let bin = usize::from(bins.bin(class, steps));
                table.push(bin as u8);
                firsts.resize((start + bin + 1).max(firsts.len()), steps);
            }
            firsts.resize(start + BINS, longest + 1);
        }
        BinSteps {
            firsts,
            bins: table,
            longest,
        }
    }

    /// Returns the bin of a number of steps; steps beyond the longest ray count as the longest.
    #[inline(always)]
    pub(crate) fn bin(&self, class: usize, steps: u16) -> u8 {
        self.bins[class * (usize::from(self.longest) + 1) + usize::from(steps.min(self.longest))]
    }

    /// Returns the range of the steps in bins `first..=last`, the end exclusive.
    #[inline(always)]
    pub(crate) fn span(&self, class: usize, first: u8, last: u8) -> (u16, u16) {
        let firsts = &self.firsts[class * BINS..][..BINS];
        let end = usize::from(last) + 1;
        (
            firsts[usize::from(first)],
            if end < BINS { firsts[end] } else { 0 },
        )
    }
}
