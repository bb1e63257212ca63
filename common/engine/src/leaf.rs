//! Counting votes, pose by pose, for the 64 cells of a small block at once.
//!
//! The ranges of all cells in all directions are laid out side by side, so that
//! a beam's votes for the whole block are one table look-up for each cell. With
//! AVX-512 all 64 look-ups are one instruction.

use crate::directions::Direction;
use crate::grid::{Cell, Grid};
use crate::lines::{LineIndex, NO_RANGE};
use crate::program::ScanProgram;
use crate::space::Space;
use crate::tables::{TABLE, VoteTable, VoteTables};

/// Cells along the side of a block.
pub(crate) const SIDE: usize = 8;

/// Cells of a block, row by row.
pub(crate) const CELLS: usize = SIDE * SIDE;

/// The ranges of a block's cells in every direction.
#[derive(Debug, Clone)]
pub(crate) struct LeafRanges {
    by_direction: Vec<[u16; CELLS]>,
    open: [bool; CELLS],
}

impl LeafRanges {
    pub(crate) fn new(space: &Space) -> Self {
        LeafRanges {
            by_direction: vec![[NO_RANGE; CELLS]; space.directions.count()],
            open: [false; CELLS],
        }
    }

    /// Whether the robot may stand in a cell.
    pub(crate) fn is_open(&self, cell: usize) -> bool {
        self.open[cell]
    }

    /// Looks out from the block whose lowest cell is (`left`, `bottom`), in the
    /// directions that are needed; ranges in the others are left as they were.
    pub(crate) fn fill(
        &mut self,
        grid: &Grid,
        lines: &LineIndex,
        space: &Space,
        (left, bottom): (usize, usize),
        needed: &[bool],
    ) {
        let mut cells = [None; CELLS];
        for (i, cell) in cells.iter_mut().enumerate() {
            *cell = grid.get((left + i % SIDE) as i64, (bottom + i / SIDE) as i64);
            self.open[i] = *cell == Some(Cell::Open);
        }
        for (d, direction) in space
            .directions
            .all()
            .iter()
            .enumerate()
            .filter(|(d, _)| needed[*d])
        {
            let outlook = |i: usize| lines.range(d, left + i % SIDE, bottom + i / SIDE);
            let origin = if direction.x_major { left } else { bottom };
            sweep(
                direction,
                origin as i64,
                &cells,
                outlook,
                &mut self.by_direction[d],
            );
        }
    }
}

/// Ranges of all cells along one direction: those at the block's far edge by
/// `outlook`, the others from the next cell.
fn sweep(
    direction: &Direction,
    origin: i64,
    cells: &[Option<Cell>; CELLS],
    outlook: impl Fn(usize) -> u16,
    ranges: &mut [u16; CELLS],
) {
    let index = |major: usize, minor: usize| {
        if direction.x_major {
            minor * SIDE + major
        } else {
            major * SIDE + minor
        }
    };
    for step in 0..SIDE {
        let major = if direction.step > 0 {
            SIDE - 1 - step
        } else {
            step
        };
        let at = origin + major as i64;
        let shift = direction.minor(at + direction.step) - direction.minor(at);
        let next_major = (major as i64 + direction.step) as usize;
        for minor in 0..SIDE {
            let next_minor = (minor as i64 + shift) as usize;
            let i = index(major, minor);
            ranges[i] = match cells[i] {
                Some(Cell::Occupied) => 0,
                None | Some(Cell::Blocked) => NO_RANGE,
                Some(Cell::Open) if next_major < SIDE && next_minor < SIDE => {
                    ranges[index(next_major, next_minor)].saturating_add(1)
                }
                Some(Cell::Open) => outlook(i),
            };
        }
    }
}

/// A scan program laid out for counting in blocks.
#[derive(Debug, Clone)]
pub(crate) struct LeafProgram {
    bearings: Vec<usize>,
    tables: VoteTables,
    /// Class of each direction, for two turns.
    class_of: Vec<usize>,
}

impl LeafProgram {
    pub(crate) fn new(program: &ScanProgram, space: &Space) -> Self {
        let directions = &space.directions;
        LeafProgram {
            bearings: (0..program.beams())
                .map(|beam| program.bearing(beam))
                .collect(),
            tables: VoteTables::new(program, directions),
            class_of: (0..2 * directions.count())
                .map(|d| directions.get(d).class)
                .collect(),
        }
    }

    /// Marks the directions that beams have at a heading.
    pub(crate) fn mark_needed(&self, heading: usize, needed: &mut [bool]) {
        for &bearing in &self.bearings {
            let direction = heading + bearing;
            needed[if direction < needed.len() {
                direction
            } else {
                direction - needed.len()
            }] = true;
        }
    }

    /// Intensities of the block's cells at a heading; meaningless where a cell
    /// is not open.
    pub(crate) fn count(&self, ranges: &LeafRanges, heading: usize) -> [u16; CELLS] {
        #[cfg(target_arch = "x86_64")]
        if self.tables.are_short()
            && is_x86_feature_detected!("avx512bw")
            && is_x86_feature_detected!("avx512vbmi")
        {
            // SAFETY: the processor has the features that the function is compiled for.
            return unsafe { self.count_avx512(ranges, heading) };
        }
        self.count_portable(ranges, heading)
    }

    fn count_portable(&self, ranges: &LeafRanges, heading: usize) -> [u16; CELLS] {
        let mut counts = [0u16; CELLS];
        for (beam, &bearing) in self.bearings.iter().enumerate() {
            let (table, ranges) = self.look(ranges, heading + bearing, beam);
            table.add_portable(ranges, &mut counts);
        }
        counts
    }

    /// A beam's table and the cells' ranges in a direction of two turns.
    #[inline(always)]
    fn look<'a>(
        &'a self,
        ranges: &'a LeafRanges,
        direction: usize,
        beam: usize,
    ) -> (VoteTable<'a>, &'a [u16; CELLS]) {
        let table = self.tables.get(beam, self.class_of[direction]);
        let count = ranges.by_direction.len();
        (
            table,
            &ranges.by_direction[if direction < count {
                direction
            } else {
                direction - count
            }],
        )
    }

    #[cfg(target_arch = "x86_64")]
    #[target_feature(enable = "avx512f,avx512bw,avx512vbmi")]
    fn count_avx512(&self, ranges: &LeafRanges, heading: usize) -> [u16; CELLS] {
        use std::arch::x86_64::*;
        // As many votes of at most 16 as fit into a byte.
        const BEAMS_A_BYTE: usize = 15;
        let zero = _mm512_setzero_si512();
        let last = _mm512_set1_epi16(TABLE as i16 - 1);
        let (mut low, mut high) = (zero, zero);
        for (chunk, bearings) in self.bearings.chunks(BEAMS_A_BYTE).enumerate() {
            let mut bytes = zero;
            for (beam, &bearing) in bearings.iter().enumerate() {
                let (table, ranges) =
                    self.look(ranges, heading + bearing, chunk * BEAMS_A_BYTE + beam);
                let centre = _mm512_set1_epi16(table.centre as i16);
                let table = &table.votes[..TABLE];
                // SAFETY: both slices and the array are as long as what is read of them.
                let (table, first, second) = unsafe {
                    (
                        _mm512_loadu_si512(table.as_ptr().cast()),
                        _mm512_loadu_si512(ranges.as_ptr().cast()),
                        _mm512_loadu_si512(ranges[CELLS / 2..].as_ptr().cast()),
                    )
                };
                let distance = |range| {
                    let off = _mm512_or_si512(
                        _mm512_subs_epu16(range, centre),
                        _mm512_subs_epu16(centre, range),
                    );
                    _mm512_min_epu16(off, last)
                };
                let index = _mm512_packus_epi16(distance(first), distance(second));
                bytes = _mm512_add_epi8(bytes, _mm512_permutexvar_epi8(index, table));
            }
            low = _mm512_add_epi16(low, _mm512_unpacklo_epi8(bytes, zero));
            high = _mm512_add_epi16(high, _mm512_unpackhi_epi8(bytes, zero));
        }
        // Packing put eight cells of each half in turn; unpacking took each
        // such group of eight back, into `low` from the first half.
        let mut counts = [0; CELLS];
        let (first, second) = counts.split_at_mut(CELLS / 2);
        // SAFETY: each half holds the 32 numbers that are stored to it.
        unsafe {
            _mm512_storeu_si512(first.as_mut_ptr().cast(), low);
            _mm512_storeu_si512(second.as_mut_ptr().cast(), high);
        }
        counts
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::testing::{any_grid, any_scan, space_of};
    use crate::{boundary, reference};

    proptest! {
        #[test]
        fn counts_equal_the_reference_on_every_instruction_set(
            grid in any_grid(), scan in any_scan(), headings in 1u32..12, seed in any::<[usize; 3]>(),
        ) {
            let space = space_of(&grid, headings * 8);
            let program = scan.program(&space);
            let lines = LineIndex::new(
                grid.width(), grid.height(),
                &boundary::extract(&grid), &boundary::blocked(&grid), &space.directions,
            );
            let (left, bottom) = (seed[0] % grid.width() / SIDE * SIDE, seed[1] % grid.height() / SIDE * SIDE);
            let heading = seed[2] % space.directions.count();
            let mut ranges = LeafRanges::new(&space);
            let leaf = LeafProgram::new(&program, &space);
            let mut needed = vec![false; space.directions.count()];
            leaf.mark_needed(heading, &mut needed);
            ranges.fill(&grid, &lines, &space, (left, bottom), &needed);
            let (portable, chosen) = (leaf.count_portable(&ranges, heading), leaf.count(&ranges, heading));
            for i in 0..CELLS {
                let (x, y) = ((left + i % SIDE) as i64, (bottom + i / SIDE) as i64);
                prop_assert_eq!(ranges.is_open(i), grid.is_open(x, y));
                if ranges.is_open(i) {
                    let plain = reference::intensity(&grid, &program, &space, x, y, heading);
                    prop_assert_eq!((portable[i], chosen[i]), (plain, plain), "{:?}", (x, y));
                }
            }
        }
    }
}
