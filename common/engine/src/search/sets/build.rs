//! Builds the sets of 2 × 2 blocks from the intervals of the blocks.

use std::ops::Range;

use super::marks::{CHUNK, Chunk, Mark};
use crate::instruction_set::InstructionSet;
use crate::search::bins::Bins;
use crate::search::intervals::RangeIntervals;
use crate::search::lanes::Portable;

/// Rows of bits, block by block.
#[derive(Debug, Clone, Default)]
pub(super) struct BitRows {
    /// How many rows each block has.
    pub rows: Vec<u32>,
    pub bits: Vec<u8>,
}

/// The rows of the blocks in some rows of `columns` blocks.
pub(super) fn build(
    set: InstructionSet,
    intervals: &RangeIntervals,
    shift: u32,
    block_rows: Range<usize>,
) -> BitRows {
    match set.checked() {
        InstructionSet::Portable => join(Portable, intervals, shift, block_rows),
        #[cfg(target_arch = "x86_64")]
        // SAFETY: the processor has the features that the function is compiled for.
        InstructionSet::Avx2 => unsafe { join_avx2(intervals, shift, block_rows) },
        #[cfg(target_arch = "x86_64")]
        // SAFETY: as above.
        InstructionSet::Avx512 => unsafe { join_avx512(intervals, shift, block_rows) },
        #[cfg(not(target_arch = "x86_64"))]
        _ => unreachable!("checked above"),
    }
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2")]
fn join_avx2(intervals: &RangeIntervals, shift: u32, block_rows: Range<usize>) -> BitRows {
    join(
        crate::search::lanes::Avx2::new(),
        intervals,
        shift,
        block_rows,
    )
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx512f,avx512bw,avx512dq,avx512vl")]
fn join_avx512(intervals: &RangeIntervals, shift: u32, block_rows: Range<usize>) -> BitRows {
    join(
        crate::search::lanes::Avx512::new(),
        intervals,
        shift,
        block_rows,
    )
}

#[inline(always)]
fn join<M: Mark>(
    marker: M,
    intervals: &RangeIntervals,
    shift: u32,
    block_rows: Range<usize>,
) -> BitRows {
    let chunks = intervals.directions.div_ceil(CHUNK);
    let stride = intervals.directions / 8;
    let mut joined = BitRows::default();
    // A row of words for each row of bits.
    let mut words = vec![0u64; chunks << (u8::BITS - shift)];
    for y in block_rows {
        for x in 0..intervals.columns.div_ceil(2) {
            let mut rows = 0;
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
                    words[usize::from(row) * chunks + chunk_index] =
                        marker.mark(row, &chunk).to_le();
                    rows = rows.max(usize::from(row) + 1);
                }
            }
            for words in words[..rows * chunks].chunks_exact_mut(chunks) {
                joined
                    .bits
                    .extend_from_slice(&bytemuck::cast_slice(words)[..stride]);
                words.fill(0);
            }
            joined.rows.push(rows as u32);
        }
    }
    joined
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
