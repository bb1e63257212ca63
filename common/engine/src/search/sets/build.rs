//! Builds the sets of 2 × 2 blocks of intervals.

use std::ops::Range;

use super::Byte;
use super::marks::{CHUNK, Chunk, Mark};
use crate::instruction_set::InstructionSet;
use crate::search::bins::Bins;
use crate::search::bits::QUAD;
use crate::search::intervals::RangeIntervals;
use crate::search::lanes::Portable;

/// No rows: any others start before and end behind.
#[expect(clippy::reversed_empty_ranges, reason = "it is where growing starts")]
const NONE: Range<usize> = usize::MAX..0;

/// Rows of bits, quad by quad.
#[derive(Debug, Clone, Default)]
pub(super) struct Rows {
    /// Which rows of each quad have any bits.
    pub rows: Vec<Range<usize>>,
    pub bits: Vec<Byte>,
}

/// The rows of the quads in some rows of them.
pub(super) fn build(
    set: InstructionSet,
    intervals: &RangeIntervals,
    shift: u32,
    quad_rows: Range<usize>,
) -> Rows {
    match set.checked() {
        InstructionSet::Portable => join(Portable, intervals, shift, quad_rows),
        #[cfg(target_arch = "x86_64")]
        // SAFETY: the processor has the features that the function is compiled for.
        InstructionSet::Avx2 => unsafe { join_avx2(intervals, shift, quad_rows) },
        #[cfg(target_arch = "x86_64")]
        // SAFETY: as above.
        InstructionSet::Avx512 => unsafe { join_avx512(intervals, shift, quad_rows) },
        #[cfg(not(target_arch = "x86_64"))]
        _ => unreachable!("checked above"),
    }
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2")]
fn join_avx2(intervals: &RangeIntervals, shift: u32, quad_rows: Range<usize>) -> Rows {
    join(
        crate::search::lanes::Avx2::new(),
        intervals,
        shift,
        quad_rows,
    )
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx512f,avx512bw,avx512dq,avx512vl")]
fn join_avx512(intervals: &RangeIntervals, shift: u32, quad_rows: Range<usize>) -> Rows {
    join(
        crate::search::lanes::Avx512::new(),
        intervals,
        shift,
        quad_rows,
    )
}

#[inline(always)]
fn join<M: Mark>(
    marker: M,
    intervals: &RangeIntervals,
    shift: u32,
    quad_rows: Range<usize>,
) -> Rows {
    let chunks = intervals.directions.div_ceil(CHUNK);
    let stride = intervals.directions / 8;
    let mut joined = Rows::default();
    // For each block of a quad, a row of words for each row of bits.
    let mut words = [(); QUAD].map(|()| vec![0u64; chunks << (u8::BITS - shift)]);
    for y in quad_rows {
        for x in 0..intervals.columns.div_ceil(4) {
            let mut rows = NONE;
            for (place, words) in words.iter_mut().enumerate() {
                let (x, y) = (2 * x + place % 2, 2 * y + place / 2);
                let marked = mark(marker, intervals, shift, (x, y), words);
                rows = rows.start.min(marked.start)..rows.end.max(marked.end);
            }
            if rows.is_empty() {
                rows = 0..0;
            }
            for row in rows.clone() {
                let [a, b, c, d] = words
                    .each_ref()
                    .map(|words| &bytemuck::cast_slice(&words[row * chunks..])[..stride]);
                let turn = a.iter().zip(b).zip(c).zip(d);
                joined
                    .bits
                    .extend(turn.map(|(((&a, &b), &c), &d)| [a, b, c, d]));
            }
            for words in &mut words {
                words[rows.start * chunks..rows.end * chunks].fill(0);
            }
            joined.rows.push(rows);
        }
    }
    joined
}

/// Marks what the block in column `x` and row `y` sees in words, of which all are 0:
/// in which rows.
#[inline(always)]
fn mark<M: Mark>(
    marker: M,
    intervals: &RangeIntervals,
    shift: u32,
    (x, y): (usize, usize),
    words: &mut [u64],
) -> Range<usize> {
    let chunks = intervals.directions.div_ceil(CHUNK);
    let mut rows = NONE;
    for chunk_index in 0..chunks {
        let start = CHUNK * chunk_index;
        let mut chunk = Chunk::new(shift);
        for i in 0..4 {
            let (x, y) = (2 * x + i % 2, 2 * y + i / 2);
            if x < intervals.columns && y < intervals.rows {
                set(&mut chunk, i, intervals, y * intervals.columns + x, start);
            }
        }
        for row in chunk.rows() {
            words[usize::from(row) * chunks + chunk_index] = marker.mark(row, &chunk).to_le();
            rows = rows.start.min(row.into())..rows.end.max(usize::from(row) + 1);
        }
    }
    rows
}

/// Takes the intervals of a block in the directions from `start` on.
#[inline(always)]
fn set(chunk: &mut Chunk, i: usize, intervals: &RangeIntervals, block: usize, start: usize) {
    let [nearest, farthest, widths] = intervals.packed(block);
    if let (Some(nearest), Some(farthest), Some(widths)) = (
        nearest[start..].first_chunk(),
        farthest[start..].first_chunk(),
        widths[start..].first_chunk(),
    ) {
        chunk.set(i, [nearest, farthest, widths]);
        return;
    }
    // Behind the last direction nothing is seen.
    let mut rows = [[Bins::NOTHING; CHUNK], [0; CHUNK], [0; CHUNK]];
    for (row, packed) in rows.iter_mut().zip([nearest, farthest, widths]) {
        let packed = &packed[start..];
        row[..packed.len()].copy_from_slice(packed);
    }
    let [nearest, farthest, widths] = &rows;
    chunk.set(i, [nearest, farthest, widths]);
}
