//! Directions of 64 that see into a row of bins, as the bits of a word.

use std::ops::RangeInclusive;

use crate::search::index::bins::Bins;
use crate::search::index::intervals::{ROW_SHIFT, far_start, near_end};
use crate::simd::Set;
use crate::simd::headings::{HEADINGS, present};

/// Number of directions that are marked at a time.
pub(super) const CHUNK: usize = HEADINGS;

/// A byte for the near and for the far interval of each of four blocks, in 64 directions.
type ByInterval = [[u8; CHUNK]; 8];

/// The intervals of joined blocks in 64 directions, for rows of some bins each.
#[derive(Debug, Clone)]
pub(super) struct Chunk {
    /// First bin of each interval. If there is none it is 0, which is no bin.
    firsts: ByInterval,
    /// Largest distance from the first bin to the end of a row that meets the interval.
    reaches: ByInterval,
    nearest: [u8; CHUNK],
    farthest: [u8; CHUNK],
}

/// Last bin of the first row.
const LAST: u8 = (1 << ROW_SHIFT) - 1;

impl Default for Chunk {
    /// The intervals of no block.
    #[inline(always)]
    fn default() -> Self {
        Chunk {
            firsts: [[0; CHUNK]; _],
            reaches: [[0; CHUNK]; _],
            nearest: [Bins::NOTHING; CHUNK],
            farthest: [0; CHUNK],
        }
    }
}

impl Chunk {
    /// Takes the packed intervals of block `i` of those that are joined.
    #[inline(always)]
    pub(super) fn set(&mut self, i: usize, [nearest, farthest, widths]: [&[u8; CHUNK]; 3]) {
        for d in 0..CHUNK {
            let (nearest, farthest, widths) = (nearest[d], farthest[d], widths[d]);
            let near_end = near_end(nearest, farthest, widths);
            let far_start = far_start(nearest, farthest, widths);
            // All ones where anything is seen.
            let seen = if farthest == 0 { 0 } else { u8::MAX };
            self.firsts[2 * i][d] = nearest & seen;
            self.firsts[2 * i + 1][d] = far_start & seen;
            self.reaches[2 * i][d] = near_end.wrapping_sub(nearest).saturating_add(LAST) & seen;
            self.reaches[2 * i + 1][d] =
                farthest.wrapping_sub(far_start).saturating_add(LAST) & seen;
            self.nearest[d] = self.nearest[d].min(nearest);
            self.farthest[d] = self.farthest[d].max(farthest);
        }
    }

    /// Returns the rows between the ends of all intervals.
    #[inline(always)]
    pub(super) fn rows(&self) -> RangeInclusive<u8> {
        let (mut nearest, mut farthest) = (Bins::NOTHING, 0);
        for d in 0..CHUNK {
            nearest = nearest.min(self.nearest[d]);
            farthest = farthest.max(self.farthest[d]);
        }
        nearest >> ROW_SHIFT..=farthest >> ROW_SHIFT
    }

    /// Leaves out the intervals of block `i` in a direction; [`Chunk::rows`] still covers them.
    #[inline(always)]
    pub(super) fn leave_out(&mut self, i: usize, direction: usize) {
        for interval in [2 * i, 2 * i + 1] {
            self.firsts[interval][direction] = 0;
            self.reaches[interval][direction] = 0;
        }
    }

    /// Returns a bit for each direction in which a row of bins meets any interval.
    #[inline(always)]
    pub(super) fn mark<S: Set>(&self, set: S, row: u8) -> u64 {
        let end = (row << ROW_SHIFT) | LAST;
        // Distance of the row's end beyond the nearest reach; bytes wrap from 255 to 0.
        let mut off = [u8::MAX; CHUNK];
        for (firsts, reaches) in self.firsts.iter().zip(&self.reaches) {
            for ((off, first), &reach) in off.iter_mut().zip(firsts).zip(reaches) {
                *off = (*off).min(end.wrapping_sub(*first).saturating_sub(reach));
            }
        }
        !present(set, off)
    }
}
