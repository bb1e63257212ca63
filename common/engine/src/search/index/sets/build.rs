//! Builds the sets of 2 × 2 blocks of intervals from these or, where they are wide, from
//! the views noted there.

use std::ops::Range;

use super::RangeSets;
use super::marks::{CHUNK, Chunk};
use crate::search::index::bins::Bins;
use crate::search::index::bits;
use crate::search::index::block_ids::quad_of;
use crate::search::index::intervals::{ROW_SHIFT, RangeIntervals, WideViews};
use crate::simd::words::QUAD;
use crate::simd::{Kernel, Set};

/// No rows; the range from which others grow.
#[expect(clippy::reversed_empty_ranges, reason = "it is where growing starts")]
const NONE: Range<usize> = usize::MAX..0;

/// Kernel that joins the sets of all quads, and adds them to those without any.
pub(super) struct Joining<'a>(pub &'a RangeIntervals, pub &'a WideViews, pub RangeSets);

impl Kernel for Joining<'_> {
    type Result = RangeSets;

    #[inline(always)]
    fn run<S: Set>(self, set: S) -> RangeSets {
        let Joining(intervals, wide, mut joined) = self;
        let stride = intervals.directions / 8;
        let mut chunks = vec![Chunk::default(); intervals.directions.div_ceil(CHUNK)];
        let mut turn = vec![[0; QUAD]; stride];
        // For each block of a quad, a row of words for each row of bits.
        let mut words = [(); QUAD].map(|()| vec![0u64; chunks.len() << (u8::BITS - ROW_SHIFT)]);
        let blocks = (joined.columns, joined.rows);
        for quad in 0..blocks.0.div_ceil(2) * blocks.1.div_ceil(2) {
            let mut rows = NONE;
            for (block, words) in quad_of(quad, blocks).into_iter().zip(&mut words) {
                let Some(block) = block else { continue };
                let marked = mark(set, (intervals, wide), block, &mut chunks, words);
                rows = rows.start.min(marked.start)..rows.end.max(marked.end);
            }
            if rows.is_empty() {
                rows = 0..0;
            }
            joined.push(rows.clone(), &mut turn, |row, turn| {
                let row = row * chunks.len();
                let [a, b, c, d] = words
                    .each_ref()
                    .map(|words| &bytemuck::cast_slice(&words[row..])[..stride]);
                let bytes = a.iter().zip(b).zip(c).zip(d);
                let bytes = bytes.map(|(((&a, &b), &c), &d)| [a, b, c, d]);
                turn.iter_mut().zip(bytes).for_each(|(to, byte)| *to = byte);
            });
            for words in &mut words {
                words[rows.start * chunks.len()..rows.end * chunks.len()].fill(0);
            }
        }
        joined.finished()
    }
}

/// Marks the distances that a block sees in `words`, all of which must be 0. Returns the range of their rows. `chunks` are buffers for the
/// directions of a turn.
#[inline(always)]
fn mark<S: Set>(
    set: S,
    (intervals, wide): (&RangeIntervals, &WideViews),
    block: usize,
    chunks: &mut [Chunk],
    words: &mut [u64],
) -> Range<usize> {
    let count = chunks.len();
    chunks.fill(Chunk::default());
    let quarters = quad_of(block, (intervals.columns, intervals.rows));
    for (i, quarter) in quarters.into_iter().enumerate() {
        let Some(block) = quarter.filter(|&block| intervals.ids.holds(block)) else {
            continue;
        };
        for (chunk_index, chunk) in chunks.iter_mut().enumerate() {
            take(chunk, i, intervals, block, CHUNK * chunk_index);
        }
        for (direction, rows) in wide.of(intervals.ids.before(block)) {
            let (chunk_index, lane) = (direction / CHUNK, direction % CHUNK);
            chunks[chunk_index].leave_out(i, lane);
            for row in bits::ones(rows) {
                words[row * count + chunk_index] |= (1u64 << lane).to_le();
            }
        }
    }
    let mut rows = NONE;
    for (chunk_index, chunk) in chunks.iter().enumerate() {
        for row in chunk.rows() {
            words[usize::from(row) * count + chunk_index] |= chunk.mark(set, row).to_le();
            rows = rows.start.min(row.into())..rows.end.max(usize::from(row) + 1);
        }
    }
    rows
}

/// Takes the intervals of a block in the directions from `start` on into a chunk.
#[inline(always)]
fn take(chunk: &mut Chunk, i: usize, intervals: &RangeIntervals, block: usize, start: usize) {
    let [nearest, farthest, widths] = intervals.packed(block);
    if let (Some(nearest), Some(farthest), Some(widths)) = (
        nearest[start..].first_chunk(),
        farthest[start..].first_chunk(),
        widths[start..].first_chunk(),
    ) {
        chunk.set(i, [nearest, farthest, widths]);
        return;
    }
    // Nothing is seen after the last direction.
    let mut rows = [[Bins::NOTHING; CHUNK], [0; CHUNK], [0; CHUNK]];
    for (row, packed) in rows.iter_mut().zip([nearest, farthest, widths]) {
        let packed = &packed[start..];
        row[..packed.len()].copy_from_slice(packed);
    }
    let [nearest, farthest, widths] = &rows;
    chunk.set(i, [nearest, farthest, widths]);
}
