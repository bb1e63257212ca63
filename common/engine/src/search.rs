//! The search over x, y and all headings, exact by bounds.
//!
//! Blocks of cells wait in a queue by the most votes that any of their poses
//! could have. The most promising block is split, or, at the finest level, its
//! poses are counted one by one at the headings that may still matter. When no
//! block can reach the floor any more, every pose above it has been seen.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use messages::{BoundaryCell, Vote};

use crate::boundary;
use crate::bounds::{BlockRanges, BoundProgram};
use crate::grid::{Cell, Grid};
use crate::intervals::Intervals;
use crate::lines::LineIndex;
use crate::program::ScanProgram;
use crate::space::Space;
use crate::votes::{CollectConfig, Collector, VoteSet};

/// A map prepared for searches: made once for each map.
#[derive(Debug, Clone)]
pub struct SearchIndex {
    lines: LineIndex,
    intervals: Intervals,
}

/// A block in the queue; the order is by bound, then by place.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Block {
    bound: u16,
    level: Reverse<usize>,
    index: Reverse<usize>,
}

impl SearchIndex {
    /// Prepares a map whose boundary is given.
    #[must_use]
    pub fn new(grid: &Grid, boundary: &[BoundaryCell], space: &Space) -> Self {
        let blocked = boundary::blocked(grid);
        SearchIndex {
            lines: LineIndex::new(
                grid.width(),
                grid.height(),
                boundary,
                &blocked,
                &space.directions,
            ),
            intervals: Intervals::new(grid, &space.directions),
        }
    }

    /// Bytes that the index takes.
    #[must_use]
    pub fn bytes(&self) -> usize {
        self.lines.bytes() + self.intervals.bytes()
    }

    /// The poses with the most votes; `None` if `stop` said so before the end.
    #[must_use]
    pub fn search(
        &self,
        grid: &Grid,
        program: &ScanProgram,
        space: &Space,
        config: CollectConfig,
        stop: &dyn Fn() -> bool,
    ) -> Option<VoteSet> {
        Search {
            index: self,
            grid,
            program,
            space,
            bounds: BoundProgram::new(program, &space.directions),
            block_ranges: BlockRanges::new(space.directions.count()),
            row: vec![0; space.directions.count()],
            collector: Collector::new(config),
            queue: BinaryHeap::new(),
            poses_evaluated: 0,
        }
        .run(stop)
    }
}

/// One search under way.
struct Search<'a> {
    index: &'a SearchIndex,
    grid: &'a Grid,
    program: &'a ScanProgram,
    space: &'a Space,
    bounds: BoundProgram,
    block_ranges: BlockRanges,
    /// Bounds of one block by heading.
    row: Vec<u16>,
    collector: Collector,
    queue: BinaryHeap<Block>,
    poses_evaluated: u64,
}

impl Search<'_> {
    fn run(mut self, stop: &dyn Fn() -> bool) -> Option<VoteSet> {
        let levels = self.index.intervals.levels();
        let coarsest = levels.len() - 1;
        for block in 0..levels[coarsest].columns * levels[coarsest].rows {
            self.enqueue(coarsest, block);
        }
        let mut leaf = Leaf::new(self.space);
        while let Some(Block {
            bound,
            level: Reverse(level),
            index: Reverse(block),
        }) = self.queue.pop()
        {
            if bound < self.collector.floor() {
                break;
            }
            if stop() {
                return None;
            }
            if level > 0 {
                self.split(level, block);
            } else {
                self.count(block, &mut leaf);
            }
        }
        Some(self.collector.finish(self.poses_evaluated))
    }

    /// Computes the bounds of a block and queues it, if it may still matter.
    fn enqueue(&mut self, level: usize, block: usize) {
        self.bound_block(level, block);
        let bound = self.row.iter().copied().max().unwrap_or(0);
        if bound >= self.collector.floor() {
            self.queue.push(Block {
                bound,
                level: Reverse(level),
                index: Reverse(block),
            });
        }
    }

    fn bound_block(&mut self, level: usize, block: usize) {
        self.block_ranges
            .set(self.index.intervals.levels()[level].block(block));
        self.bounds.bound(&self.block_ranges, &mut self.row);
    }

    /// Queues the four blocks of the next finer level.
    fn split(&mut self, level: usize, block: usize) {
        let levels = self.index.intervals.levels();
        let (coarse, fine) = (&levels[level], &levels[level - 1]);
        let (x, y) = (2 * (block % coarse.columns), 2 * (block / coarse.columns));
        for (x, y) in [(x, y), (x + 1, y), (x, y + 1), (x + 1, y + 1)] {
            if x < fine.columns && y < fine.rows {
                self.enqueue(level - 1, y * fine.columns + x);
            }
        }
    }

    /// Counts the votes of a block's poses at the headings that may matter.
    fn count(&mut self, block: usize, leaf: &mut Leaf) {
        self.bound_block(0, block);
        let floor = self.collector.floor();
        let headings = self
            .row
            .iter()
            .enumerate()
            .filter(|&(_, &bound)| bound >= floor);
        leaf.headings.clear();
        leaf.headings.extend(headings.map(|(heading, _)| heading));
        let level = &self.index.intervals.levels()[0];
        let (left, bottom) = (
            block % level.columns * level.side,
            block / level.columns * level.side,
        );
        let (width, height) = (self.grid.width(), self.grid.height());
        for y in bottom..height.min(bottom + level.side) {
            for x in left..width.min(left + level.side) {
                if self.grid.cells()[y * width + x] == Cell::Open {
                    self.count_cell(x, y, leaf);
                }
            }
        }
    }

    fn count_cell(&mut self, x: usize, y: usize, leaf: &mut Leaf) {
        self.index.lines.ranges(x, y, &mut leaf.ranges);
        self.poses_evaluated += leaf.headings.len() as u64;
        for &heading in &leaf.headings {
            let votes = (0..self.program.beams()).map(|beam| {
                let direction = leaf.wrap[heading + self.program.bearing(beam)];
                let taper = self.program.taper(beam, leaf.classes[direction]);
                u16::from(taper.votes(leaf.ranges[direction]))
            });
            let intensity = votes.sum();
            self.collector.take(Vote {
                x: x as u16,
                y: y as u16,
                heading: heading as u16,
                intensity,
            });
        }
    }
}

/// Buffers for counting the poses of one block.
struct Leaf {
    headings: Vec<usize>,
    /// Of one cell, by direction.
    ranges: Vec<u16>,
    classes: Vec<usize>,
    /// Directions modulo a turn, for two turns.
    wrap: Vec<usize>,
}

impl Leaf {
    fn new(space: &Space) -> Self {
        let count = space.directions.count();
        Leaf {
            headings: Vec::with_capacity(count),
            ranges: vec![0; count],
            classes: space
                .directions
                .all()
                .iter()
                .map(|direction| direction.class)
                .collect(),
            wrap: (0..2 * count).map(|direction| direction % count).collect(),
        }
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::reference;
    use crate::testing::{any_grid, any_scan, space_of};

    /// All poses by the plain reference, collected in the same way.
    fn plain(grid: &Grid, program: &ScanProgram, space: &Space, config: CollectConfig) -> VoteSet {
        let mut collector = Collector::new(config);
        for heading in 0..space.directions.count() {
            let field = reference::field(grid, program, space, heading);
            for (i, &intensity) in field.iter().enumerate() {
                let (x, y) = ((i % grid.width()) as u16, (i / grid.width()) as u16);
                collector.take(Vote {
                    x,
                    y,
                    heading: heading as u16,
                    intensity,
                });
            }
        }
        collector.finish(0)
    }

    proptest! {
        #[test]
        fn the_search_equals_the_reference(
            grid in any_grid(), scan in any_scan(), headings in 1u32..8,
            floor_share in 0.5..=1.0f64, max_votes in 1u32..400,
        ) {
            let space = space_of(&grid, headings * 8);
            let program = scan.program(&space);
            let config = CollectConfig { floor_share, max_votes };
            let index = SearchIndex::new(&grid, &boundary::extract(&grid), &space);
            let found = index.search(&grid, &program, &space, config, &|| false);
            let found = found.map(|set| VoteSet { poses_evaluated: 0, ..set });
            prop_assert_eq!(found, Some(plain(&grid, &program, &space, config)));
        }
    }

    #[test]
    fn a_search_that_is_told_to_stop_has_no_outcome() {
        let grid = crate::grid::drawn::grid(&["####", "#..#", "####"]);
        let space = space_of(&grid, 8);
        let scan = crate::scan::Scan {
            angle_min: 0.0,
            angle_increment: 1.0,
            range_min_m: 0.0,
            range_max_m: 9.0,
            ranges: &[0.1, 0.1],
        };
        let program = ScanProgram::new(&scan, 0.0, &space, &Default::default()).unwrap();
        let index = SearchIndex::new(&grid, &boundary::extract(&grid), &space);
        let config = CollectConfig::default();
        assert!(
            index
                .search(&grid, &program, &space, config, &|| true)
                .is_none()
        );
        assert!(
            index
                .search(&grid, &program, &space, config, &|| false)
                .is_some()
        );
    }
}
