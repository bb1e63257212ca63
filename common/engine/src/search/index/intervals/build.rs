//! Builds the intervals of all blocks by range sweeps, strip by strip.
//!
//! Directions with the same major axis and sense sweep together: a strip of
//! blocks is done in all of them before the next one, so that what is built
//! leaves the cache once, with the bytes of a block side by side.

use std::convert::Infallible;
use std::ops::Range;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};

use super::pool::pool;
use super::strip::{Row, RowLayout, StripMasks};
use super::strip_blocks::StripBlocks;
use super::transpose::{TILE, WORD, transpose};
use super::wide::{Noting, WideView};
use super::{PACKED, SIDE};
use crate::directions::{Directions, swap_unless};
use crate::grid::Grid;
use crate::search::index::bins::Bins;
use crate::search::index::bits;
use crate::search::index::block_ids::BlockIds;
use crate::search::index::steps::BinSteps;
use crate::simd::{Kernel, Set, Simd};
use crate::threads;

/// Input for building the intervals.
#[derive(Debug, Clone, Copy)]
pub(super) struct Source<'a> {
    pub grid: &'a Grid,
    pub directions: &'a Directions,
    pub bins: &'a Bins,
    pub steps: &'a BinSteps,
    /// Blocks whose intervals are wanted.
    pub ids: &'a BlockIds,
}

/// The packed intervals of the wanted blocks in [`TILE`] rows of blocks. Threads fill
/// them in different directions and take turns at that.
struct Band<'a> {
    /// Number of its first wanted block.
    first: usize,
    packed: Mutex<&'a mut [u8]>,
}

/// Fills the packed intervals of the wanted blocks, row by row. Returns the views where
/// they are wide, as each thread found them.
pub(super) fn build(
    source: Source<'_>,
    simd: Simd,
    threads: usize,
    packed: &mut [u8],
) -> Vec<Vec<WideView>> {
    let bands = bands(source, packed);
    let parts = parts(source.directions, threads);
    let next = AtomicUsize::new(0);
    let mut views = vec![Vec::new(); threads];
    let Ok(()) = threads::run(&mut views, &|| false, |_, views, _| {
        let bands = &bands;
        let mut built = Built { bands, views };
        while let Some(part) = parts.get(next.fetch_add(1, Ordering::Relaxed)) {
            let built = &mut built;
            simd.run(Sweeping {
                source,
                part,
                built,
            });
        }
        Ok::<(), Infallible>(())
    });
    views
}

fn bands<'a>(source: Source<'_>, mut packed: &'a mut [u8]) -> Vec<Band<'a>> {
    let Source {
        grid,
        directions,
        ids,
        ..
    } = source;
    let (columns, rows) = (grid.width().div_ceil(SIDE), grid.height().div_ceil(SIDE));
    let mut bands = Vec::with_capacity(rows.div_ceil(TILE));
    for row in (0..rows).step_by(TILE) {
        let first = ids.before(row * columns);
        let end = ids.before((row + TILE).min(rows) * columns);
        let bytes = (end - first) * PACKED * directions.count();
        let (band, rest) = packed.split_at_mut(bytes);
        bands.push(Band {
            first,
            packed: Mutex::new(band),
        });
        packed = rest;
    }
    bands
}

/// Output: the packed intervals, and the views where they are wide.
struct Built<'a, 'b> {
    bands: &'a [Band<'b>],
    views: &'a mut Vec<WideView>,
}

/// Directions that sweep together.
#[derive(Debug, Clone)]
struct Part {
    x_major: bool,
    forward: bool,
    /// In ascending order.
    directions: Vec<usize>,
}

/// Returns all directions by major axis and sense, in as many pieces as threads need.
fn parts(directions: &Directions, threads: usize) -> Vec<Part> {
    let mut parts = Vec::new();
    for (x_major, forward) in [(true, true), (true, false), (false, true), (false, false)] {
        let alike = |&d: &usize| {
            let direction = directions.get(d);
            direction.x_major == x_major && (direction.step > 0) == forward
        };
        let all: Vec<usize> = (0..directions.count()).filter(alike).collect();
        let pieces = threads.div_ceil(2);
        parts.extend(
            all.chunks(all.len().div_ceil(pieces).max(1))
                .map(|piece| Part {
                    x_major,
                    forward,
                    directions: piece.to_vec(),
                }),
        );
    }
    parts
}

/// Kernel that sweeps in the directions of a part.
struct Sweeping<'a, 'b, 'c> {
    source: Source<'a>,
    part: &'a Part,
    built: &'a mut Built<'b, 'c>,
}

impl Kernel for Sweeping<'_, '_, '_> {
    type Result = ();

    #[inline(always)]
    fn run<S: Set>(self, set: S) {
        sweep(set, self.source, self.part, self.built);
    }
}

#[inline(always)]
fn sweep<S: Set>(lanes: S, source: Source<'_>, part: &Part, built: &mut Built<'_, '_>) {
    let (width, height) = (source.grid.width(), source.grid.height());
    let longest = (width.max(height) - 1) as u16;
    let (majors, minors) = swap_unless(part.x_major, (width, height));
    let row_blocks = width.div_ceil(SIDE);
    let (strips, blocks) = (majors.div_ceil(SIDE), minors.div_ceil(SIDE));
    let layout = RowLayout::new(blocks);
    let mut masks = StripMasks::new(layout);
    let mut swept = vec![Row::new(layout); part.directions.len()];
    let mut between: [Row; SIDE - 1] = std::array::from_fn(|_| Row::new(layout));
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
                masks.sweep(lanes, row, shift, next, ranges);
            }
            let rows = [&*a, b, c, swept];
            let mut noting = Noting {
                views: &mut *built.views,
                steps: source.steps,
                direction: d,
                class: direction.class,
                blocks: &strip_blocks,
            };
            if longest <= Bins::NEAR_STEPS {
                pool(
                    lanes,
                    rows,
                    source.bins.near_lines(direction.class),
                    planes.of(slot),
                    &mut noting,
                );
            } else {
                pool(
                    lanes,
                    rows,
                    source.bins.lines(direction.class),
                    planes.of(slot),
                    &mut noting,
                );
            }
        }
        planes.write(part, strip, &strip_blocks, built.bands);
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
    fn write(&mut self, part: &Part, strip: usize, blocks: &StripBlocks<'_>, bands: &[Band<'_>]) {
        let bytes = PACKED * self.directions;
        for tile in 0..blocks.tiles() {
            let start = tile * TILE;
            let wanted = blocks.wanted(start, TILE);
            if wanted == 0 {
                continue;
            }
            // A tile along a column of blocks is as high as a band.
            let band = if part.x_major { tile } else { strip / TILE };
            let Band { first, packed } = &bands[band];
            let place = |block: usize| bytes * (blocks.id(start + block) - first);
            let mut packed = packed.lock().unwrap_or_else(PoisonError::into_inner);
            self.turn(start);
            for block in bits::ones(wanted) {
                self.write_block(block, &mut packed[place(block)..][..bytes]);
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
