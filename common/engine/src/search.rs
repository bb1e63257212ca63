//! The search over x, y and all headings, exact by bounds.
//!
//! Blocks of 16 × 16 cells are bounded by their sets of visible ranges, for all
//! headings at once, and wait in a queue by the most votes that any of their
//! poses could have. The most promising block is split into four of 8 × 8 with
//! bounds of their own; the poses of those are counted one by one, at the
//! headings that may still matter. When no block in the queue can reach the
//! floor any more, every pose above it has been seen.

use std::collections::BinaryHeap;
use std::ops::Range;

use messages::{BoundaryCell, Vote};

use crate::boundary;
use crate::grid::Grid;
use crate::leaf::{self, LeafProgram, LeafRanges};
use crate::lines::LineIndex;
use crate::program::ScanProgram;
use crate::set_bounds::{SetBounds, SetProgram};
use crate::sets::{BlockSets, RangeSets};
use crate::space::Space;
use crate::votes::{CollectConfig, Collector, VoteSet};

/// A map prepared for searches: made once for each map.
#[derive(Debug, Clone)]
pub struct SearchIndex {
    lines: LineIndex,
    fine: RangeSets,
    coarse: RangeSets,
}

impl SearchIndex {
    /// Prepares a map whose boundary is given.
    #[must_use]
    pub fn new(grid: &Grid, boundary: &[BoundaryCell], space: &Space) -> Self {
        let directions = &space.directions;
        let blocked = boundary::blocked(grid);
        let fine = RangeSets::new(grid, leaf::SIDE, directions);
        let coarse = fine.joined();
        let lines = LineIndex::new(grid.width(), grid.height(), boundary, &blocked, directions);
        SearchIndex {
            lines,
            fine,
            coarse,
        }
    }

    /// Bytes that the index takes.
    #[must_use]
    pub fn bytes(&self) -> usize {
        self.lines.bytes() + self.fine.bytes() + self.coarse.bytes()
    }

    /// The poses with the most votes, and what bounds those of each coarse
    /// block; `None` if `stop` said so before the end.
    #[must_use]
    pub fn search(
        &self,
        grid: &Grid,
        program: &ScanProgram,
        space: &Space,
        config: CollectConfig,
        stop: &dyn Fn() -> bool,
    ) -> Option<(VoteSet, BlockBounds)> {
        Search::new(self, grid, program, space, config).run(stop)
    }
}

/// Upper bounds of the intensities in square blocks, row by row from the
/// lowest y.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct BlockBounds {
    /// Cells along the side of a block.
    pub side: usize,
    /// Blocks along x.
    pub columns: usize,
    /// No pose in the block, at any heading, has more votes.
    pub bounds: Vec<u16>,
}

impl BlockBounds {
    /// Blocks along y.
    #[must_use]
    pub fn rows(&self) -> usize {
        self.bounds.len() / self.columns
    }
}

/// A block in the queue; the order is by bound, then by place.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
struct Block {
    bound: u16,
    index: usize,
    content: Content,
}

/// What a block in the queue is.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
enum Content {
    /// 16 × 16 cells, to be split.
    Coarse,
    /// 8 × 8 cells, to be counted at these of the search's candidate headings.
    Fine { start: usize, end: usize },
}

/// A heading at which a block may still matter, and its bound there.
#[derive(Debug, Clone, Copy)]
struct Candidate {
    heading: u16,
    bound: u16,
}

/// One search under way.
struct Search<'a> {
    index: &'a SearchIndex,
    grid: &'a Grid,
    space: &'a Space,
    set_program: SetProgram,
    leaf_program: LeafProgram,
    block_sets: BlockSets,
    coarse_bounds: SetBounds,
    fine_bounds: SetBounds,
    leaf_ranges: LeafRanges,
    /// Directions to look in, for one block.
    needed: Vec<bool>,
    candidates: Vec<Candidate>,
    queue: BinaryHeap<Block>,
    collector: Collector,
    poses_evaluated: u64,
}

impl<'a> Search<'a> {
    fn new(
        index: &'a SearchIndex,
        grid: &'a Grid,
        program: &ScanProgram,
        space: &'a Space,
        config: CollectConfig,
    ) -> Self {
        let set_program = SetProgram::new(program, &space.directions);
        Search {
            index,
            grid,
            space,
            block_sets: BlockSets::new(),
            coarse_bounds: set_program.bounds(),
            fine_bounds: set_program.bounds(),
            set_program,
            leaf_program: LeafProgram::new(program, space),
            leaf_ranges: LeafRanges::new(space),
            needed: vec![false; space.directions.count()],
            candidates: Vec::new(),
            queue: BinaryHeap::new(),
            collector: Collector::new(config),
            poses_evaluated: 0,
        }
    }

    fn run(mut self, stop: &dyn Fn() -> bool) -> Option<(VoteSet, BlockBounds)> {
        let mut bounds = Vec::with_capacity(self.index.coarse.blocks());
        for index in 0..self.index.coarse.blocks() {
            if stop() {
                return None;
            }
            self.bound_coarse(index);
            let bound = self.coarse_bounds.greatest();
            bounds.push(bound);
            if bound >= self.collector.floor() {
                self.queue.push(Block {
                    bound,
                    index,
                    content: Content::Coarse,
                });
            }
        }
        while let Some(block) = self.queue.pop() {
            if block.bound < self.collector.floor() {
                break;
            }
            if stop() {
                return None;
            }
            match block.content {
                Content::Coarse => self.split(block.index),
                Content::Fine { start, end } => self.count(block.index, start..end),
            }
        }
        let coarse = &self.index.coarse;
        let bounds = BlockBounds {
            side: coarse.side,
            columns: coarse.columns,
            bounds,
        };
        Some((self.collector.finish(self.poses_evaluated), bounds))
    }

    fn bound_coarse(&mut self, index: usize) {
        self.block_sets.set(&self.index.coarse, index);
        self.set_program
            .bound(&self.block_sets, &mut self.coarse_bounds);
    }

    /// Queues the four blocks of 8 × 8 cells in one of 16 × 16.
    fn split(&mut self, index: usize) {
        let (coarse, fine) = (&self.index.coarse, &self.index.fine);
        let (x, y) = (2 * (index % coarse.columns), 2 * (index / coarse.columns));
        self.bound_coarse(index);
        for (x, y) in [(x, y), (x + 1, y), (x, y + 1), (x + 1, y + 1)] {
            if x < fine.columns && y < fine.rows {
                self.enqueue_fine(y * fine.columns + x);
            }
        }
    }

    /// Queues a block at the headings that the block around it leaves.
    fn enqueue_fine(&mut self, index: usize) {
        let floor = self.collector.floor();
        self.block_sets.set(&self.index.fine, index);
        self.set_program
            .bound(&self.block_sets, &mut self.fine_bounds);
        let start = self.candidates.len();
        for heading in self.fine_bounds.at_least(floor, &self.coarse_bounds) {
            let bound = self.fine_bounds.at(heading);
            self.candidates.push(Candidate {
                heading: heading as u16,
                bound,
            });
        }
        let end = self.candidates.len();
        if let Some(bound) = self.candidates[start..]
            .iter()
            .map(|candidate| candidate.bound)
            .max()
        {
            self.queue.push(Block {
                bound,
                index,
                content: Content::Fine { start, end },
            });
        }
    }

    /// Counts the votes of a block's poses at the candidate headings.
    fn count(&mut self, index: usize, candidates: Range<usize>) {
        let columns = self.index.fine.columns;
        let (left, bottom) = (index % columns * leaf::SIDE, index / columns * leaf::SIDE);
        self.look_out((left, bottom), candidates.clone());
        for candidate in candidates {
            let Candidate { heading, bound } = self.candidates[candidate];
            if bound < self.collector.floor() {
                continue;
            }
            let counts = self
                .leaf_program
                .count(&self.leaf_ranges, usize::from(heading));
            self.poses_evaluated += leaf::CELLS as u64;
            for (i, &intensity) in counts.iter().enumerate() {
                if self.leaf_ranges.is_open(i) {
                    let (x, y) = (
                        (left + i % leaf::SIDE) as u16,
                        (bottom + i / leaf::SIDE) as u16,
                    );
                    self.collector.take(Vote {
                        x,
                        y,
                        heading,
                        intensity,
                    });
                }
            }
        }
    }

    /// Fills in the ranges of a block in the directions that its candidate
    /// headings need.
    fn look_out(&mut self, block: (usize, usize), candidates: Range<usize>) {
        let floor = self.collector.floor();
        self.needed.fill(false);
        for candidate in self.candidates[candidates]
            .iter()
            .filter(|candidate| candidate.bound >= floor)
        {
            self.leaf_program
                .mark_needed(usize::from(candidate.heading), &mut self.needed);
        }
        self.leaf_ranges.fill(
            self.grid,
            &self.index.lines,
            self.space,
            block,
            &self.needed,
        );
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
            let (found, bounds) = found.unwrap();
            let found = VoteSet { poses_evaluated: 0, ..found };
            for vote in &found.votes {
                let block = usize::from(vote.y) / bounds.side * bounds.columns + usize::from(vote.x) / bounds.side;
                prop_assert!(vote.intensity <= bounds.bounds[block]);
            }
            prop_assert_eq!(found, plain(&grid, &program, &space, config));
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
