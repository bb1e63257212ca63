//! How many steps the bins of distances stand for.

use super::bins::Bins;
use crate::directions::Directions;

/// Where each bin starts, by class of directions.
#[derive(Debug, Clone)]
pub(crate) struct BinSteps {
    /// The least steps in each bin or a later one, 256 for each class.
    firsts: Vec<u16>,
    /// The bin of each number of steps up to the longest ray, class by class.
    bins: Vec<u8>,
    longest: u16,
}

const BINS: usize = 256;

impl BinSteps {
    /// For rays of up to `longest` steps.
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

    /// The bin of a number of steps; more steps than any ray has count as those
    /// of the longest.
    #[inline(always)]
    pub(crate) fn bin(&self, class: usize, steps: u16) -> u8 {
        self.bins[class * (usize::from(self.longest) + 1) + usize::from(steps.min(self.longest))]
    }

    /// The steps in bins `first..=last`, without the end.
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
