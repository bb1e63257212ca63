//! Adds up the windows of a group of beams. Plane `i` of a sum holds bit `i` of it, at all
//! headings of a chunk and for all blocks of a quad.
//!
//! Carry-save adders turn three rows of bits into a sum and a carry for the next plane, so
//! adding a window to all these sums takes two operations, and as many again for its
//! carries.

use super::quad_rows::{Extent, QuadRows, RowLayout, Window, Windows};
use crate::simd::Set;
use crate::simd::words::Words;

/// Rows carried over to the plane that is being added up, to the next one, and to the one
/// after it.
pub(crate) type Carries = [Vec<Words>; 3];

/// Beams with the same bearing modulo 8.
#[derive(Debug, Clone, Default)]
pub(crate) struct Group {
    /// Bearing modulo 8.
    shift: u32,
    /// Windows with a share of `1 << i` units, by `i`.
    planes: Vec<Plane>,
    /// Most units that the beams can give together.
    pub possible: u16,
    /// Number of reads for a chunk of a quad.
    pub reads: u32,
    /// Extent of all windows.
    extent: Extent,
}

/// Windows with the same share.
#[derive(Debug, Clone, Default)]
struct Plane {
    windows: Vec<Window>,
    /// Windows in pairs, sorted by how often each is read; a window that sees nothing fills up
    /// the last pair.
    pairs: Vec<[Window; 2]>,
}

impl Group {
    /// Starts without windows, for a bearing modulo 8; the buffers stay.
    pub(crate) fn start(&mut self, shift: u32) {
        for plane in &mut self.planes {
            plane.windows.clear();
            plane.pairs.clear();
        }
        self.shift = shift;
        self.possible = 0;
        self.reads = 0;
        self.extent = Extent::default();
    }

    pub(crate) fn push(&mut self, plane: usize, window: Window) {
        self.possible += 1 << plane;
        self.reads += window.reads;
        self.extent.take(&window);
        if self.planes.len() <= plane {
            self.planes.resize_with(plane + 1, Plane::default);
        }
        self.planes[plane].windows.push(window);
    }

    /// Lays out the windows that were pushed; `nothing`, a window that sees nothing, fills up
    /// pairs.
    pub(crate) fn lay_out(&mut self, nothing: Window) {
        self.extent.take(&nothing);
        for Plane { windows, pairs } in &mut self.planes {
            windows.sort_unstable_by_key(|window| window.reads);
            let (full, rest) = windows.as_chunks();
            pairs.extend(full);
            pairs.extend(rest.iter().map(|&window| [nothing, window]));
        }
    }

    /// Largest number of words carried over from a plane to another.
    pub(crate) fn carries(&self) -> usize {
        let windows: usize = self.planes.iter().map(|plane| plane.windows.len()).sum();
        windows.div_ceil(2) + 1
    }

    /// Adds up the windows plane by plane with carry-save adders, in the rows of a quad at the
    /// headings of a chunk, and adds the result to `total`, the sums of all groups.
    #[inline(always)]
    pub(crate) fn add<S: Set>(
        &self,
        set: S,
        rows: (&RowLayout, &QuadRows, usize),
        carries: &mut Carries,
        total: &mut [Words],
    ) {
        let windows = Windows::new(rows, &self.extent);
        let [mut carries, mut next, mut after] = carries.each_mut().map(|rows| &mut rows[..]);
        let (mut carried, mut carried_next) = (0, 0);
        let mut planes = self.planes.iter();
        let mut twos = Words::EMPTY;
        // Carry of the addition to the total.
        let mut overflow = Words::EMPTY;
        let (own, others) = total.split_at_mut(self.sum_planes().min(total.len()));
        for total in own {
            let mut column = Column::new(twos, after);
            if let Some(plane) = planes.next() {
                column.add_windows(windows, plane);
            }
            column.add_rows(&carries[..carried]);
            let (ones, made) = (column.ones, column.made);
            twos = column.twos;
            let sum = set.sorted(ones).shift_down(self.shift);
            (*total, overflow) = total.full_adder(sum, overflow);
            (carries, next, after) = (next, after, carries);
            (carried, carried_next) = (carried_next, made);
        }
        for total in others {
            (*total, overflow) = total.full_adder(overflow, Words::EMPTY);
        }
    }

    /// Number of planes that hold every sum of the beams.
    fn sum_planes(&self) -> usize {
        (u16::BITS - self.possible.leading_zeros()) as usize
    }
}

/// Adder of one plane: `ones` is its sum so far and `twos` that of the next plane. Each
/// pair of rows that is added leaves a row in `carries` for the plane after these two.
struct Column<'a> {
    ones: Words,
    twos: Words,
    carries: &'a mut [Words],
    made: usize,
}

impl<'a> Column<'a> {
    #[inline(always)]
    fn new(ones: Words, carries: &'a mut [Words]) -> Self {
        Column {
            ones,
            twos: Words::EMPTY,
            carries,
            made: 0,
        }
    }

    #[inline(always)]
    fn add_windows(&mut self, windows: Windows<'_>, plane: &Plane) {
        // SAFETY: `windows` was made for the extent of the group, which has taken in all windows of
        // its planes and the one that fills up pairs.
        let read = |window: &Window, reads| unsafe { windows.read(window, reads) };
        for [a, b] in &plane.pairs {
            self.add_pair(read(a, b.reads), read(b, b.reads));
        }
    }

    #[inline(always)]
    fn add_rows(&mut self, rows: &[Words]) {
        let (pairs, rest) = rows.as_chunks();
        for &[a, b] in pairs {
            self.add_pair(a, b);
        }
        for &row in rest {
            self.add_pair(row, Words::EMPTY);
        }
    }

    #[inline(always)]
    fn add_pair(&mut self, a: Words, b: Words) {
        let (carry, over);
        (self.ones, carry) = self.ones.full_adder(a, b);
        (self.twos, over) = self.twos.full_adder(carry, Words::EMPTY);
        self.carries[self.made] = over;
        self.made += 1;
    }
}

#[cfg(test)]
mod tests {
    use std::ops::Range;

    use proptest::collection::vec;
    use proptest::prelude::*;

    use super::*;
    use crate::instruction_set::InstructionSet;
    use crate::search::index::bits::{CHUNK, PLANES};
    use crate::search::index::sets::{Byte, SetRows};
    use crate::simd::words::QUAD;
    use crate::simd::{Kernel, Simd};

    /// Exclusive limit of the bytes of a row.
    const STRIDES: usize = if cfg!(miri) { 5 } else { 50 };

    /// Rows of a quad, numbered from the first field on; a byte has a bit for each of 8
    /// directions, for each block.
    #[derive(Debug, Clone)]
    struct Rows(usize, Vec<Vec<Byte>>);

    /// True if a block sees anything in some rows in a direction.
    fn sees(
        Rows(first, plain): &Rows,
        rows: &Range<usize>,
        direction: usize,
        block: usize,
    ) -> bool {
        plain.iter().zip(*first..).any(|(row, number)| {
            rows.contains(&number) && row[direction / 8][block] >> (direction % 8) & 1 == 1
        })
    }

    /// Takes quads one after the other, and adds up the windows of a group in the last one, at
    /// the headings of a chunk.
    struct Adding<'a> {
        group: &'a Group,
        layout: &'a RowLayout,
        quads: &'a [Rows],
        chunk: usize,
    }

    impl Kernel for Adding<'_> {
        /// Sums by plane.
        type Result = [Words; PLANES];

        #[inline(always)]
        fn run<S: Set>(self, set: S) -> Self::Result {
            let mut rows = QuadRows::default();
            rows.fit(self.layout);
            for Rows(first, plain) in self.quads {
                SetRows::of(*first, plain, |packed| {
                    rows.take(set, self.layout, packed);
                });
            }
            let carries = vec![Words::EMPTY; self.group.carries()];
            let mut carries = [carries.clone(), carries.clone(), carries];
            let mut total = [Words::EMPTY; PLANES];
            let rows = (self.layout, &rows, self.chunk);
            self.group.add(set, rows, &mut carries, &mut total);
            total
        }
    }

    fn any_rows(stride: usize) -> impl Strategy<Value = Rows> {
        // Most bytes have no bits.
        let byte = prop_oneof![3 => Just([0; QUAD]), 1 => any::<Byte>()];
        let rows = (0usize..58, vec(vec(byte, stride), 0..6));
        rows.prop_map(|(first, plain)| Rows(first, plain))
    }

    prop_compose! {
        fn any_window(stride: usize)(
            start in 0usize..60, length in 1usize..5, byte in 0..stride, plane in 0usize..4,
        ) -> (usize, Range<usize>, usize) {
            (plane, start..start + length, byte)
        }
    }

    proptest! {
        #[test]
        fn sums_are_those_of_the_windows_that_see_anything(
            (stride, quads, windows) in (1..STRIDES).prop_flat_map(|stride| {
                (Just(stride), vec(any_rows(stride), 1..4), vec(any_window(stride), 0..20))
            }),
            shift in 0u32..8, place in any::<prop::sample::Index>(),
        ) {
            let directions = 8 * stride;
            let mut layout = RowLayout::default();
            layout.start(directions);
            let mut group = Group::default();
            group.start(shift);
            for (plane, rows, byte) in &windows {
                group.push(*plane, layout.window(rows.clone(), *byte));
            }
            group.lay_out(layout.nothing());
            let last = place.index(directions.div_ceil(CHUNK));
            for set in InstructionSet::available() {
                let (group, layout, quads) = (&group, &layout, &quads[..]);
                for chunk in [0, last] {
                    let planes = Simd::new(set).run(Adding { group, layout, quads, chunk });
                    for (lane, block) in (0..CHUNK).flat_map(|lane| (0..QUAD).map(move |block| (lane, block))) {
                        let sees = |(plane, rows, byte): &(usize, Range<usize>, usize)| {
                            let direction = chunk * CHUNK + lane + 8 * byte + shift as usize;
                            u32::from(sees(&quads[quads.len() - 1], rows, direction % directions, block)) << plane
                        };
                        let expected: u32 = windows.iter().map(sees).sum();
                        let bit = |words: &Words| (words.block(block) >> lane & 1) as u32;
                        let sum: u32 = planes.iter().enumerate().map(|(i, words)| bit(words) << i).sum();
                        prop_assert_eq!(sum, expected, "{} chunk {} lane {} block {}", set, chunk, lane, block);
                    }
                }
            }
        }
    }
}
