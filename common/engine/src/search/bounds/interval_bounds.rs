//! Upper bounds of the votes in a small block from its intervals of ranges.
//!
//! A beam votes most for the range of an interval that is nearest to its reading. Intervals
//! of adjacent directions are adjacent in memory, so one table look-up bounds a beam at 64
//! headings.

use super::interval_program::{IntervalBeam, IntervalProgram};
use crate::search::index::bits::ones;
use crate::search::index::intervals::BlockIntervals;
use crate::simd::headings::{self, HEADINGS};
use crate::simd::{Kernel, Set};

/// Upper bounds of a block's votes at adjacent headings.
#[derive(Debug, Clone)]
pub(crate) struct IntervalBounds {
    /// Bounds for all beams together.
    pub all: [u16; HEADINGS],
    /// Bounds for each sector of beams, in the order in which they are counted.
    pub sectors: Vec<[u8; HEADINGS]>,
    /// Headings at which each beam may vote, as bits, with the beams in that order.
    pub voting: Vec<u64>,
}

impl Default for IntervalBounds {
    fn default() -> Self {
        IntervalBounds {
            all: [0; HEADINGS],
            sectors: Vec::new(),
            voting: Vec::new(),
        }
    }
}

impl IntervalBounds {
    /// Returns the headings that a word selects with a bound of at least `least`, as bits, and
    /// the greatest of these bounds.
    pub(crate) fn reach(&self, least: u16, among: u64) -> (u64, u16) {
        let reaching = ones(among).filter(|&lane| self.all[lane] >= least);
        reaching.fold((0, 0), |(reach, most), lane| {
            (reach | 1 << lane, most.max(self.all[lane]))
        })
    }
}

impl IntervalProgram {
    /// Bounds the votes of a block at the 64 headings from `first` on. Returns true if any of
    /// these may have `least` votes; if not, the bounds are left unfinished. `DETAILED` finds the
    /// bounds of sectors and beams, too.
    pub(crate) fn bound<const DETAILED: bool>(
        &self,
        block: &BlockIntervals,
        first: usize,
        least: u16,
        bounds: &mut IntervalBounds,
    ) -> bool {
        self.simd.run(Bounding::<DETAILED> {
            program: self,
            block,
            first,
            least,
            bounds,
        })
    }

    #[inline(always)]
    fn direction(&self, beam: &IntervalBeam, heading: usize) -> usize {
        let direction = heading + usize::from(beam.bearing);
        if direction < self.directions {
            direction
        } else {
            direction - self.directions
        }
    }
}

/// Kernel that bounds a block; `DETAILED` finds the bounds of sectors and beams, too.
struct Bounding<'a, const DETAILED: bool> {
    program: &'a IntervalProgram,
    block: &'a BlockIntervals,
    first: usize,
    least: u16,
    bounds: &'a mut IntervalBounds,
}

impl<const DETAILED: bool> Kernel for Bounding<'_, DETAILED> {
    type Result = bool;

    #[inline(always)]
    fn run<S: Set>(self, set: S) -> bool {
        let Bounding {
            program,
            block,
            first,
            least,
            bounds,
        } = self;
        let rows = block.rows();
        bounds.all = [0; HEADINGS];
        bounds.sectors.clear();
        bounds.voting.clear();
        for (beams, rest) in program.sectors() {
            let mut votes = [0; HEADINGS];
            for beam in beams {
                let direction = program.direction(beam, first);
                let of_beam = beam.votes.add(set, rows.from(direction), &mut votes);
                if DETAILED {
                    bounds.voting.push(headings::present(set, of_beam));
                }
            }
            let mut most = 0;
            for (all, votes) in bounds.all.iter_mut().zip(votes) {
                *all += u16::from(votes);
                most = most.max(*all);
            }
            if DETAILED {
                bounds.sectors.push(votes);
            }
            if most + rest < least {
                return false;
            }
        }
        true
    }
}
