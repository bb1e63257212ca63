//! Which of 64 directions see into a bin, as the bits of a word.

#[cfg(target_arch = "x86_64")]
use std::arch::x86_64::*;
use std::ops::RangeInclusive;

use crate::search::index::bins::Bins;
use crate::search::index::intervals::{ROW_SHIFT, far_start, near_end};
use crate::search::index::lanes::Portable;
#[cfg(target_arch = "x86_64")]
use crate::search::index::lanes::{Avx2, Avx512};

/// Directions that are marked at a time.
pub(super) const CHUNK: usize = 64;

/// Blocks that are joined.
const BLOCKS: usize = 4;

/// Intervals of all of them: near and far.
const INTERVALS: usize = 2 * BLOCKS;

/// The intervals of joined blocks in 64 directions, for rows of some bins each.
#[derive(Debug, Clone)]
pub(super) struct Chunk {
    /// First bin of each interval. Where there is none it is 0, which is no bin.
    firsts: [[u8; CHUNK]; INTERVALS],
    /// How far behind the first bin a row can end that meets the interval.
    reaches: [[u8; CHUNK]; INTERVALS],
    nearest: [u8; CHUNK],
    farthest: [u8; CHUNK],
}

/// The last bin of the first row.
const LAST: u8 = (1 << ROW_SHIFT) - 1;

impl Default for Chunk {
    /// The intervals of no block.
    #[inline(always)]
    fn default() -> Self {
        Chunk {
            firsts: [[0; CHUNK]; INTERVALS],
            reaches: [[0; CHUNK]; INTERVALS],
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

    /// The rows between the ends of all intervals.
    #[inline(always)]
    pub(super) fn rows(&self) -> RangeInclusive<u8> {
        let (mut nearest, mut farthest) = (Bins::NOTHING, 0);
        for d in 0..CHUNK {
            nearest = nearest.min(self.nearest[d]);
            farthest = farthest.max(self.farthest[d]);
        }
        nearest >> ROW_SHIFT..=farthest >> ROW_SHIFT
    }

    /// Leaves out the intervals of block `i` in a direction, but for how far they reach.
    #[inline(always)]
    pub(super) fn leave_out(&mut self, i: usize, direction: usize) {
        for interval in [2 * i, 2 * i + 1] {
            self.firsts[interval][direction] = 0;
            self.reaches[interval][direction] = 0;
        }
    }
}

/// The last bin of a row.
#[inline(always)]
fn end(row: u8) -> u8 {
    (row << ROW_SHIFT) | LAST
}

/// Marks the directions in which a row of bins meets any interval.
pub(super) trait Mark: Copy {
    /// A bit for each direction.
    fn mark(self, row: u8, chunk: &Chunk) -> u64;
}

impl Mark for Portable {
    #[inline(always)]
    fn mark(self, row: u8, chunk: &Chunk) -> u64 {
        let end = end(row);
        // By how much the row misses the nearest interval.
        let mut off = [u8::MAX; CHUNK];
        for (firsts, reaches) in chunk.firsts.iter().zip(&chunk.reaches) {
            for ((off, first), &reach) in off.iter_mut().zip(firsts).zip(reaches) {
                *off = (*off).min(end.wrapping_sub(*first).saturating_sub(reach));
            }
        }
        let mut bits = 0;
        for (i, off) in off.as_chunks::<8>().0.iter().enumerate() {
            let inside = u64::from_le_bytes(off.map(|off| u8::from(off == 0)));
            // Carries byte `j` to bit `56 + j`.
            bits |= inside.wrapping_mul(0x0102_0408_1020_4080) >> 56 << (8 * i);
        }
        bits
    }
}

#[cfg(target_arch = "x86_64")]
impl Mark for Avx2 {
    #[inline(always)]
    fn mark(self, row: u8, chunk: &Chunk) -> u64 {
        const HALF: usize = CHUNK / 2;
        let mut bits = 0;
        for half in 0..2 {
            // SAFETY: `self` proves that the processor has the instructions, and
            // half a chunk is as long as a vector.
            unsafe {
                let end = _mm256_set1_epi8(end(row).cast_signed());
                let mut off = _mm256_set1_epi8(-1);
                for (firsts, reaches) in chunk.firsts.iter().zip(&chunk.reaches) {
                    let first = _mm256_loadu_si256(firsts[half * HALF..].as_ptr().cast());
                    let reach = _mm256_loadu_si256(reaches[half * HALF..].as_ptr().cast());
                    let beyond = _mm256_subs_epu8(_mm256_sub_epi8(end, first), reach);
                    off = _mm256_min_epu8(off, beyond);
                }
                let inside = _mm256_cmpeq_epi8(off, _mm256_setzero_si256());
                let inside = _mm256_movemask_epi8(inside).cast_unsigned();
                bits |= u64::from(inside) << (half * HALF);
            }
        }
        bits
    }
}

#[cfg(target_arch = "x86_64")]
impl Mark for Avx512 {
    #[inline(always)]
    fn mark(self, row: u8, chunk: &Chunk) -> u64 {
        // SAFETY: `self` proves that the processor has the instructions, and a
        // chunk is as long as a vector.
        unsafe {
            let end = _mm512_set1_epi8(end(row).cast_signed());
            let mut outside = u64::MAX;
            for (firsts, reaches) in chunk.firsts.iter().zip(&chunk.reaches) {
                let first = _mm512_loadu_si512(firsts.as_ptr().cast());
                let reach = _mm512_loadu_si512(reaches.as_ptr().cast());
                let beyond = _mm512_sub_epi8(end, first);
                outside = _mm512_mask_cmpgt_epu8_mask(outside, beyond, reach);
            }
            !outside
        }
    }
}
