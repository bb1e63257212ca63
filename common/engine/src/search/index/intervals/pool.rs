//! The packed intervals of a whole strip of blocks in one direction.

use super::strip::Row;
use super::wide::{Noting, WIDE};
use super::{ALL, PACKED, SIDE, STRETCHES};
use crate::search::index::bins::{Bins, Line};
use crate::simd::numbers::Numbers;

/// Pools the ranges of a strip's four rows of cells block by block, and packs the intervals
/// of their bins, by `lines`, row by row of the packed format. Notes the views where they
/// are wide. Skips vectors in which no block is wanted.
///
/// Ranges up to the middle between the shortest and the longest range of a block are near,
/// the rest far; or only those in the first quarter are near, if the sum of both widths is
/// smaller then. Cells that see nothing and cells in which no robot can stand must not
/// count: one step less than [`NO_RANGE`] and than the 0 of occupied cells are the two
/// greatest numbers, and -2 and -1 if signed.
///
/// [`NO_RANGE`]: crate::program::NO_RANGE
#[inline(always)]
pub(super) fn pool<L: Numbers, const LINES: usize>(
    lanes: L,
    rows: [&Row; SIDE],
    lines: &[Line; LINES],
    packed: [&mut [u8]; PACKED],
    noting: &mut Noting<'_>,
) {
    let cells: [&[u16]; SIDE * SIDE] = std::array::from_fn(|i| rows[i / SIDE].plane(i % SIDE));
    let [nearest, farthest, widths] = packed;
    let nearest = nearest.chunks_exact_mut(L::COUNT);
    let farthest = farthest.chunks_exact_mut(L::COUNT);
    let widths = widths.chunks_exact_mut(L::COUNT);
    for (chunk, ((nearest, farthest), widths)) in nearest.zip(farthest).zip(widths).enumerate() {
        let start = chunk * L::COUNT;
        if start >= cells[0].len() {
            break;
        }
        let wanted = noting.blocks.wanted(start, L::COUNT);
        if wanted == 0 {
            continue;
        }
        let one = lanes.splat(1);
        let mut steps = [lanes.splat(0); SIDE * SIDE];
        for (steps, cells) in steps.iter_mut().zip(&cells) {
            *steps = lanes.sub(lanes.load(&cells[start..]), one);
        }
        let (first, last) = outermost(lanes, &steps);
        let [nearest_bin, farthest_bin] = bin(lanes, lines, [first, last]);
        // Turns NOTHING into 0.
        let farthest_bin = lanes.sub_saturating(
            lanes.and(
                lanes.add(farthest_bin, one),
                lanes.splat(u16::from(u8::MAX)),
            ),
            one,
        );
        let middle = lanes.average(first, lanes.add(last, one));
        let quarter = lanes.average(first, middle);
        let ends = [nearest_bin, farthest_bin];
        let by_middle = split(lanes, lines, ends, part(lanes, &steps, middle));
        let by_quarter = split(lanes, lines, ends, part(lanes, &steps, quarter));
        let narrower = lanes.min(by_middle, by_quarter);
        lanes.store_bytes(nearest_bin, nearest);
        lanes.store_bytes(farthest_bin, farthest);
        lanes.store_bytes(lanes.and(narrower, lanes.splat(u16::from(u8::MAX))), widths);
        let wide = lanes.at_least(narrower, lanes.splat(u16::from(WIDE) << u8::BITS)) & wanted;
        if wide != 0 {
            noting.note(start, wide, &cells);
        }
    }
}

/// Returns the nibbles of the widths of a near and a far interval, with the sum of both
/// widths above them, so that a wider split is a greater number. Widths go from the first
/// bin to that of the last near number, and from that of the first far one to the last bin.
#[inline(always)]
fn split<L: Numbers, const LINES: usize>(
    lanes: L,
    lines: &[Line; LINES],
    [first, last]: [L::Vector; 2],
    parts: [L::Vector; 2],
) -> L::Vector {
    let [near_last, far_first] = bin(lanes, lines, parts);
    let near = lanes.sub_saturating(near_last, first);
    let far = lanes.sub_saturating(last, far_first);
    let both = lanes.min(lanes.add(near, far), lanes.splat(u16::from(u8::MAX)));
    let nibbles = lanes.or(nibble(lanes, near), lanes.shift_nibble(nibble(lanes, far)));
    lanes.or(lanes.shift_nibble(lanes.shift_nibble(both)), nibbles)
}

/// Returns the nibbles that stand for widths, some of which are rounded up.
#[inline(always)]
fn nibble<L: Numbers>(lanes: L, widths: L::Vector) -> L::Vector {
    let mut least = lanes.min(widths, lanes.splat(u16::from(ALL)));
    // From each stretch on, the width is the line `step · nibble - lag`.
    let (mut step, mut lag) = (1, 0);
    for (from, by) in STRETCHES {
        step += u16::from(by);
        lag += u16::from(by) * u16::from(from);
        // Steps are powers of two.
        let (up, share) = (
            lanes.splat(lag + step - 1),
            lanes.splat(1 << (16 - step.ilog2())),
        );
        least = lanes.min(
            least,
            lanes.mul_high(lanes.add_saturating(widths, up), share),
        );
    }
    least
}

/// Returns the first and the last number of each lane.
#[inline(always)]
fn outermost<L: Numbers>(lanes: L, steps: &[L::Vector; SIDE * SIDE]) -> (L::Vector, L::Vector) {
    let (mut first, mut last) = (steps[0], steps[0]);
    for &steps in &steps[1..] {
        first = lanes.min(first, steps);
        last = lanes.max_signed(last, steps);
    }
    (first, last)
}

/// Returns the last of the numbers below `far`, and the first of the others.
#[inline(always)]
fn part<L: Numbers>(lanes: L, steps: &[L::Vector; SIDE * SIDE], far: L::Vector) -> [L::Vector; 2] {
    // Counted from there, those below wrap around to the greatest numbers.
    let mut far_first = lanes.sub(steps[0], far);
    let mut near_last = far_first;
    for &steps in &steps[1..] {
        let beyond = lanes.sub(steps, far);
        far_first = lanes.min(far_first, beyond);
        near_last = lanes.max(near_last, beyond);
    }
    [lanes.add(far, near_last), lanes.add(far, far_first)]
}

/// Returns the bins of ranges that are one step longer than these numbers.
#[inline(always)]
fn bin<L: Numbers, const N: usize, const LINES: usize>(
    lanes: L,
    lines: &[Line; LINES],
    mut steps: [L::Vector; N],
) -> [L::Vector; N] {
    for steps in &mut steps {
        *steps = lanes.add_saturating(*steps, lanes.splat(1));
    }
    let mut bins = [lanes.splat(u16::from(Bins::NOTHING)); N];
    for line in lines {
        let (start, slope) = (lanes.splat(line.start), lanes.splat(line.slope));
        for i in 0..N {
            let bin = lanes.add(start, lanes.mul_high(steps[i], slope));
            bins[i] = lanes.min(bins[i], bin);
        }
    }
    bins
}
