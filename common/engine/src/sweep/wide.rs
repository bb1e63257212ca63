//! Beams whose tapers are too wide for a look-up: more than a hundred steps to
//! either side of the reading.
//!
//! They are rare, so this sweep is plain: ranges take 16 bits, and votes are found by
//! counting the levels down to which the taper has fallen.

use super::bits::BitGrid;
use super::kernel::Sum;
use crate::directions::Direction;
use crate::program::NO_RANGE;
use crate::program::Taper;

/// Number of cells that vote at a time.
const SIDE_BY_SIDE: usize = 32;

/// The ranges of two rows of cells, with a margin on either side.
#[derive(Debug, Default)]
pub(super) struct Rows {
    row: Vec<u16>,
    next: Vec<u16>,
}

/// Adds the votes of a beam to the sums of all cells, row by row over the
/// major axis.
pub(super) fn add<S: Sum>(
    bits: &BitGrid,
    direction: &Direction,
    taper: &Taper<'_>,
    sums: &mut [S],
    stride: usize,
    Rows { row, next }: &mut Rows,
) {
    // Cells off the map have no range.
    for row in [&mut *row, next] {
        row.clear();
        row.resize(stride + 2, NO_RANGE);
    }
    for step in 0..bits.rows {
        let major = if direction.step > 0 {
            bits.rows - 1 - step
        } else {
            step
        };
        let minor = direction.minor(major as i64);
        let shift = direction.minor(major as i64 + direction.step) - minor;
        let ahead = &next[(1 + shift) as usize..][..bits.columns];
        let (occupied, blocked) = bits.row(major);
        for (i, (range, &ahead)) in row[1..].iter_mut().zip(ahead).enumerate() {
            let is_set = |words: &[u64]| {
                words
                    .get(i / 64)
                    .is_some_and(|word| word >> (i % 64) & 1 == 1)
            };
            *range = match (is_set(occupied), is_set(blocked)) {
                (true, _) => 0,
                (_, true) => NO_RANGE,
                _ => ahead.saturating_add(1),
            };
        }
        let sums = &mut sums[major * stride..][..stride];
        for (ranges, sums) in row[1..]
            .chunks_exact(SIDE_BY_SIDE)
            .zip(sums.chunks_exact_mut(SIDE_BY_SIDE))
        {
            vote(taper, ranges, sums);
        }
        std::mem::swap(row, next);
    }
}

/// Adds the votes of neighbouring cells.
fn vote<S: Sum>(taper: &Taper<'_>, ranges: &[u16], sums: &mut [S]) {
    let mut votes = [0u8; SIDE_BY_SIDE];
    let below = taper.profile[1..].iter().chain([&0]);
    for (farthest, (here, next)) in taper.profile.iter().zip(below).enumerate() {
        if here > next {
            for (vote, range) in votes.iter_mut().zip(ranges) {
                let is_near = range.abs_diff(taper.centre) <= farthest as u16;
                *vote += if is_near { here - next } else { 0 };
            }
        }
    }
    for (sum, vote) in sums.iter_mut().zip(votes) {
        *sum += S::from(vote);
    }
}
