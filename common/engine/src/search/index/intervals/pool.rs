//! The packed intervals of a whole strip of blocks in one direction.

use super::strip::Row;
use super::wide::{Noting, WIDE};
use super::{ALL, CELLS, PACKED, SIDE, STRETCHES};
use crate::search::index::bins::{Bins, Line};

/// Blocks that are pooled at a time. Loops over their numbers have this constant length, so that
/// the compiler keeps them in registers.
const COUNT: usize = 16;

/// A number for each of these blocks.
type Numbers = [u16; COUNT];

/// Pools the ranges of a strip's four rows of cells block by block, and packs the intervals
/// of their bins, by `lines`, row by row of the packed format. Notes the views where they
/// are wide. Skips neighbours of which no block is wanted.
///
/// Ranges up to the middle between the shortest and the longest range of a block are near,
/// the rest far; or only those in the first quarter are near, if the sum of both widths is
/// smaller then. Cells that see nothing and cells in which no robot can stand must not
/// count: one step less than [`NO_RANGE`] and than the 0 of occupied cells are the two
/// greatest numbers, and -2 and -1 if signed.
///
/// [`NO_RANGE`]: crate::program::NO_RANGE
#[inline(always)]
pub(super) fn pool<const LINES: usize>(
    rows: [&Row; SIDE],
    lines: &[Line; LINES],
    packed: [&mut [u8]; PACKED],
    noting: &mut Noting<'_>,
) {
    let cells: [&[u16]; CELLS] = std::array::from_fn(|i| rows[i / SIDE].plane(i % SIDE));
    let [nearest, farthest, widths] = packed.map(|row| row.as_chunks_mut::<COUNT>().0);
    for start in (0..cells[0].len()).step_by(COUNT) {
        let wanted = noting.blocks.wanted(start, COUNT);
        if wanted == 0 {
            continue;
        }
        let mut steps = [[0; COUNT]; CELLS];
        for (steps, cells) in steps.iter_mut().zip(&cells) {
            let ranges = cells[start..].first_chunk().expect("whole cache lines");
            *steps = each(*ranges, [1; COUNT], u16::wrapping_sub);
        }
        let (first, last) = outermost(&steps);
        let [nearest_bin, farthest_bin] = bin(lines, [first, last]);
        let seen = |bin, nothing| if bin == nothing { 0 } else { bin };
        let farthest_bin = each(farthest_bin, [Bins::NOTHING.into(); COUNT], seen);
        let middle = each(first, last, |first, last| {
            average(first, last.wrapping_add(1))
        });
        let quarter = each(first, middle, average);
        let ends = [nearest_bin, farthest_bin];
        let by_middle = split(lines, ends, part(&steps, middle));
        let by_quarter = split(lines, ends, part(&steps, quarter));
        let narrower = each(by_middle, by_quarter, u16::min);
        let chunk = start / COUNT;
        nearest[chunk] = lower_bytes(nearest_bin);
        farthest[chunk] = lower_bytes(farthest_bin);
        widths[chunk] = lower_bytes(narrower);
        let mut wide = 0;
        for (i, widths) in narrower.into_iter().enumerate() {
            wide |= u64::from(widths >> u8::BITS >= u16::from(WIDE)) << i;
        }
        wide &= wanted;
        if wide != 0 {
            noting.note(start, wide, &cells);
        }
    }
}

/// Returns the nibbles of the widths of a near and a far interval, with the sum of both
/// widths above them, so that a wider split is a greater number. Widths go from the first
/// bin to that of the last near number, and from that of the first far one to the last bin.
#[inline(always)]
fn split<const LINES: usize>(
    lines: &[Line; LINES],
    [first, last]: [Numbers; 2],
    parts: [Numbers; 2],
) -> Numbers {
    let [near_last, far_first] = bin(lines, parts);
    let near = each(near_last, first, u16::saturating_sub);
    let far = each(last, far_first, u16::saturating_sub);
    each(near, far, |near, far| {
        (near + far).min(u8::MAX.into()) << u8::BITS | nibble(far) << 4 | nibble(near)
    })
}

/// Returns the nibble that stands for a width; some widths are rounded up.
#[inline(always)]
#[expect(
    clippy::manual_div_ceil,
    reason = "compilers make vectors of the sum, not of a remainder"
)]
fn nibble(width: u16) -> u16 {
    let mut least = width.min(ALL.into());
    // From each stretch on, the width is the line `step · nibble - lag`.
    let (mut step, mut lag) = (1, 0);
    for (from, by) in STRETCHES {
        step += u16::from(by);
        lag += u16::from(by) * u16::from(from);
        least = least.min((width + lag + step - 1) / step);
    }
    least
}

/// Returns the first and the last number of each block.
#[inline(always)]
fn outermost(steps: &[Numbers; CELLS]) -> (Numbers, Numbers) {
    let greater = |a: u16, b: u16| a.cast_signed().max(b.cast_signed()).cast_unsigned();
    let (mut first, mut last) = (steps[0], steps[0]);
    for &steps in &steps[1..] {
        first = each(first, steps, u16::min);
        last = each(last, steps, greater);
    }
    (first, last)
}

/// Returns the last of the numbers below `far`, and the first of the others.
#[inline(always)]
fn part(steps: &[Numbers; CELLS], far: Numbers) -> [Numbers; 2] {
    // Counted from there, those below wrap around to the greatest numbers.
    let mut far_first = each(steps[0], far, u16::wrapping_sub);
    let mut near_last = far_first;
    for &steps in &steps[1..] {
        let beyond = each(steps, far, u16::wrapping_sub);
        far_first = each(far_first, beyond, u16::min);
        near_last = each(near_last, beyond, u16::max);
    }
    [
        each(far, near_last, u16::wrapping_add),
        each(far, far_first, u16::wrapping_add),
    ]
}

/// Returns the bins of ranges that are one step longer than these numbers.
#[inline(always)]
fn bin<const N: usize, const LINES: usize>(
    lines: &[Line; LINES],
    mut steps: [Numbers; N],
) -> [Numbers; N] {
    for steps in &mut steps {
        *steps = each(*steps, [1; COUNT], u16::saturating_add);
    }
    let mut bins = [[u16::from(Bins::NOTHING); COUNT]; N];
    for line in lines {
        for (bins, &ranges) in bins.iter_mut().zip(&steps) {
            *bins = each(*bins, ranges, |bin, range| line.at(range).min(bin));
        }
    }
    bins
}

/// `(a + b + 1) / 2`.
#[inline(always)]
fn average(a: u16, b: u16) -> u16 {
    ((u32::from(a) + u32::from(b) + 1) >> 1) as u16
}

/// Returns the lower bytes of numbers.
#[inline(always)]
fn lower_bytes(numbers: Numbers) -> [u8; COUNT] {
    let mut bytes = [0; COUNT];
    for (byte, number) in bytes.iter_mut().zip(numbers) {
        *byte = number as u8;
    }
    bytes
}

/// Joins the numbers of each block. The functions of arrays are not always inlined, and would then
/// be compiled without the instructions of this set.
#[inline(always)]
fn each(a: Numbers, b: Numbers, join: impl Fn(u16, u16) -> u16) -> Numbers {
    let mut joined = a;
    for (a, b) in joined.iter_mut().zip(b) {
        *a = join(*a, b);
    }
    joined
}
