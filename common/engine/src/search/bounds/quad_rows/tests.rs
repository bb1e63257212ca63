use proptest::collection::vec;
use proptest::prelude::*;

use super::*;
use crate::instruction_set::InstructionSet;
use crate::simd::words::Words;
use crate::simd::{Kernel, Set, Simd};

/// Exclusive limit of the bytes of a row.
const STRIDES: usize = if cfg!(miri) { 5 } else { 50 };

/// Takes quads one after the other, and reads windows one by one in the last one.
struct Reading<'a> {
    layout: &'a RowLayout,
    quads: &'a [(usize, Vec<Vec<Byte>>)],
    chunk: usize,
    windows: &'a [(Window, u32)],
}

impl Kernel for Reading<'_> {
    type Result = Vec<Words>;

    #[inline(always)]
    fn run<S: Set>(self, set: S) -> Self::Result {
        let mut rows = QuadRows::default();
        rows.fit(self.layout);
        for (first, plain) in self.quads {
            SetRows::of(*first, plain, |packed| {
                rows.take::<S::Words>(set, self.layout, packed);
            });
        }
        let mut extent = Extent::default();
        self.windows
            .iter()
            .for_each(|(window, _)| extent.take(window));
        let reader = Reader::new(self.layout, &rows, self.chunk).within(&extent);
        let read = |(window, reads): &(Window, u32)| {
            // SAFETY: the extent has taken in all windows.
            let words = unsafe { reader.read::<S::Words>(set, window, *reads) };
            words.sorted().to_words()
        };
        self.windows.iter().map(read).collect()
    }
}

fn any_quad(stride: usize) -> impl Strategy<Value = (usize, Vec<Vec<Byte>>)> {
    // Most bytes have no bits.
    let byte = prop_oneof![3 => Just([0; QUAD]), 1 => any::<Byte>()];
    (0usize..58, vec(vec(byte, stride), 0..6))
}

proptest! {
    #[test]
    fn a_window_sees_what_any_of_its_rows_does(
        (stride, quads, windows) in (1..STRIDES).prop_flat_map(|stride| {
            let window = (0usize..60, 1usize..5, 0..stride, 0u32..3);
            (Just(stride), vec(any_quad(stride), 1..4), vec(window, 1..8))
        }),
        chunk in any::<prop::sample::Index>(),
    ) {
        let mut layout = RowLayout::default();
        layout.start(8 * stride);
        let mut laid_out: Vec<_> = windows.iter().map(|&(first, length, byte, more)| {
            let window = layout.window(first..first + length, byte);
            // Reading more often than needed changes nothing.
            (window, window.reads + more)
        }).collect();
        laid_out.push((layout.nothing(), 3));
        let chunk = chunk.index((8 * stride).div_ceil(CHUNK));
        let (first, plain) = &quads[quads.len() - 1];
        for set in InstructionSet::available() {
            let reading = Reading { layout: &layout, quads: &quads, chunk, windows: &laid_out };
            let found = Simd::new(set).run(reading);
            for (&(start, length, byte, _), words) in windows.iter().zip(&found) {
                for (lane, block) in (0..CHUNK).flat_map(|lane| (0..QUAD).map(move |block| (lane, block))) {
                    let direction = (chunk * CHUNK + lane + 8 * byte) % (8 * stride);
                    let sees = plain.iter().zip(*first..).any(|(row, number)| {
                        (start..start + length).contains(&number)
                            && row[direction / 8][block] >> (direction % 8) & 1 == 1
                    });
                    prop_assert_eq!(words[lane / 64][block] >> (lane % 64) & 1 == 1, sees, "{}", set);
                }
            }
            prop_assert_eq!(found[windows.len()], Words::default());
        }
    }
}

#[test]
#[should_panic(expected = "extent")]
fn windows_beyond_the_rows_are_refused() {
    let [mut small, mut large] = [RowLayout::default(), RowLayout::default()];
    small.start(8);
    large.start(720);
    let mut extent = Extent::default();
    extent.take(&large.nothing());
    let mut rows = QuadRows::default();
    rows.fit(&small);
    let _ = Reader::new(&small, &rows, 0).within(&extent);
}

#[test]
#[should_panic(expected = "extent")]
fn bearings_beyond_a_turn_are_refused() {
    let [mut small, mut large] = [RowLayout::default(), RowLayout::default()];
    small.start(8);
    large.start(720);
    let mut extent = Extent::default();
    extent.take(&large.window(0..1, 1));
    let mut rows = QuadRows::default();
    rows.fit(&small);
    let _ = Reader::new(&small, &rows, 0).within(&extent);
}
