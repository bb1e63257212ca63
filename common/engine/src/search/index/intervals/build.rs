//! Builds the intervals of all blocks by range sweeps, strip by strip.
//!
//! Directions with the same major axis and sense sweep together: a strip of
//! blocks is done in all of them before the next one, so that what is built
//! leaves the cache once, with the bytes of a block side by side.

use std::ops::Range;

use super::pool::pool;
use super::strip::{Row, StripMasks};
use super::strip_blocks::StripBlocks;
use super::transpose::{TILE, WORD, transpose};
use super::wide::{Noting, WideView};
use super::{PACKED, SIDE};
use crate::directions::{Directions, swap_unless};
use crate::grid::Grid;
use crate::search::index::bins::Bins;
use crate::search::index::bits;
use crate::search::index::block_ids::BlockIds;
use crate::simd::{Kernel, Set, Simd};

/// Input for building the intervals.
#[derive(Debug, Clone, Copy)]
pub(super) struct Source<'a> {
    pub grid: &'a Grid,
    pub directions: &'a Directions,
    pub bins: &'a Bins,
    /// Blocks whose intervals are wanted.
    pub ids: &'a BlockIds,
}

/// Fills the packed intervals of the wanted blocks, row by row. Returns the views where
/// they are wide.
pub(super) fn build(source: Source<'_>, simd: Simd, packed: &mut [u8]) -> Vec<WideView> {
    let mut views = Vec::new();
    for part in &parts(source.directions) {
        simd.run(Sweeping {
            source,
            part,
            packed: &mut *packed,
            views: &mut views,
        });
    }
    views
}

/// Directions that sweep together.
#[derive(Debug, Clone)]
struct Part {
    x_major: bool,
    forward: bool,
    /// In ascending order.
    directions: Vec<usize>,
}

/// Returns all directions by major axis and sense.
fn parts(directions: &Directions) -> [Part; 4] {
    let senses = [(true, true), (true, false), (false, true), (false, false)];
    senses.map(|(x_major, forward)| {
        let alike = |&d: &usize| {
            let direction = directions.get(d);
            direction.x_major == x_major && (direction.step > 0) == forward
        };
        Part {
            x_major,
            forward,
            directions: (0..directions.count()).filter(alike).collect(),
        }
    })
}

/// Kernel that sweeps in the directions of a part.
struct Sweeping<'a> {
    source: Source<'a>,
    part: &'a Part,
    packed: &'a mut [u8],
    views: &'a mut Vec<WideView>,
}

impl Kernel for Sweeping<'_> {
    type Result = ();

    #[inline(always)]
    fn run<S: Set>(self, _: S) {
        let Sweeping {
            source,
            part,
            packed,
            views,
        } = self;
        let (width, height) = (source.grid.width(), source.grid.height());
        let (majors, minors) = swap_unless(part.x_major, (width, height));
        let row_blocks = width.div_ceil(SIDE);
        let (strips, blocks) = (majors.div_ceil(SIDE), minors.div_ceil(SIDE));
        let mut masks = StripMasks::new(blocks);
        let mut swept = vec![Row::new(blocks); part.directions.len()];
        let mut between: [Row; SIDE - 1] = std::array::from_fn(|_| Row::new(blocks));
        let mut planes = Planes::new(part, blocks, source.directions.count());
        for i in 0..strips {
            let strip = if part.forward { strips - 1 - i } else { i };
            masks.fill(source.grid, part.x_major, strip);
            let places = if part.x_major {
                (strip, row_blocks)
            } else {
                (strip * row_blocks, 1)
            };
            let strip_blocks = StripBlocks::new(source.ids, places, blocks);
            for (slot, (&d, swept)) in part.directions.iter().zip(&mut swept).enumerate() {
                let direction = source.directions.get(d);
                let [a, b, c] = &mut between;
                for i in 0..SIDE {
                    let row = if part.forward { SIDE - 1 - i } else { i };
                    let major = (SIDE * strip + row) as i64;
                    let shift = direction.minor(major + direction.step) - direction.minor(major);
                    let (next, ranges) = match i {
                        0 => (&*swept, &mut *a),
                        1 => (&*a, &mut *b),
                        2 => (&*b, &mut *c),
                        _ => (&*c, &mut *swept),
                    };
                    masks.sweep(row, shift, next, ranges);
                }
                let rows = [&*a, b, c, swept];
                let mut noting = Noting {
                    views: &mut *views,
                    bins: source.bins,
                    direction: d,
                    class: direction.class,
                    blocks: &strip_blocks,
                };
                let lines = source.bins.lines(direction.class);
                pool(rows, lines, planes.of(slot), &mut noting);
            }
            planes.write(&strip_blocks, packed);
        }
    }
}

/// The packed intervals of a strip, direction by direction.
struct Planes {
    /// Number of directions of a turn.
    directions: usize,
    /// Bytes of a row of the packed format in one direction: one for each block.
    stride: usize,
    bytes: Vec<u8>,
    /// Bytes of a row of the packed format in one block.
    turned_stride: usize,
    /// Transposed rows of the blocks of a tile, block by block.
    turned: Vec<u8>,
    /// Runs of neighbouring directions: the place of each in the part, and its directions.
    runs: Vec<(usize, Range<usize>)>,
}

impl Planes {
    fn new(part: &Part, blocks: usize, directions: usize) -> Self {
        let stride = blocks.next_multiple_of(TILE);
        let slots = part.directions.len().next_multiple_of(WORD);
        let mut runs = Vec::new();
        let mut slot = 0;
        for run in part.directions.chunk_by(|a, b| a + 1 == *b) {
            runs.push((slot, run[0]..run[0] + run.len()));
            slot += run.len();
        }
        Planes {
            directions,
            stride,
            bytes: vec![0; PACKED * stride * slots],
            turned_stride: slots,
            turned: vec![0; PACKED * TILE * slots],
            runs,
        }
    }

    /// Returns the rows of the packed format in one direction.
    #[inline(always)]
    fn of(&mut self, slot: usize) -> [&mut [u8]; PACKED] {
        let rows = &mut self.bytes[PACKED * self.stride * slot..][..PACKED * self.stride];
        let (first, rest) = rows.split_at_mut(self.stride);
        let (second, third) = rest.split_at_mut(self.stride);
        [first, second, third]
    }

    /// Writes what was filled in into the wanted blocks of a strip.
    #[inline(always)]
    fn write(&mut self, blocks: &StripBlocks<'_>, packed: &mut [u8]) {
        let bytes = PACKED * self.directions;
        for start in (0..blocks.tiles()).map(|tile| tile * TILE) {
            let wanted = blocks.wanted(start, TILE);
            if wanted == 0 {
                continue;
            }
            self.turn(start);
            for block in bits::ones(wanted) {
                self.write_block(
                    block,
                    &mut packed[bytes * blocks.id(start + block)..][..bytes],
                );
            }
        }
    }

    /// Transposes the tile of blocks from `start` on.
    #[inline(always)]
    fn turn(&mut self, start: usize) {
        let stride = self.turned_stride;
        for slot in (0..stride).step_by(WORD) {
            for row in 0..PACKED {
                let mut words = [[0; WORD]; WORD];
                for (i, words) in words.iter_mut().enumerate() {
                    let bytes = &self.bytes[(PACKED * (slot + i) + row) * self.stride + start..];
                    *words = bytemuck::pod_read_unaligned(&bytes[..TILE]);
                }
                transpose(&mut words);
                for (block, turned) in self.turned.chunks_exact_mut(PACKED * stride).enumerate() {
                    let word = words[block % WORD][block / WORD];
                    turned[row * stride + slot..][..WORD].copy_from_slice(&word.to_ne_bytes());
                }
            }
        }
    }

    /// Writes a block of the transposed tile.
    #[inline(always)]
    fn write_block(&self, block: usize, packed: &mut [u8]) {
        let turned = &self.turned[PACKED * self.turned_stride * block..];
        for row in 0..PACKED {
            for (slot, run) in &self.runs {
                let from = &turned[row * self.turned_stride + slot..][..run.len()];
                packed[row * self.directions..][run.clone()].copy_from_slice(from);
            }
        }
    }
}
