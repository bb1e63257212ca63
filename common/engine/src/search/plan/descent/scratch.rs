//! Buffers of one thread's search.

use std::collections::BinaryHeap;

use crate::search::bounds::interval_bounds::IntervalBounds;
use crate::search::bounds::set_bounds::SetBounds;
use crate::search::index::intervals::BlockIntervals;
use crate::search::leaves::block_ranges::BlockRanges;
use crate::search::leaves::leaf::Count;
use crate::search::plan::queue::Block;
use crate::search::task::Task;
use crate::search::task::budget::Tally;
use crate::simd::headings::HEADINGS;
use crate::votes::Collector;

/// Buffers of one thread's search, kept from scan to scan.
#[derive(Debug, Default)]
pub(in crate::parts::search) struct Scratch {
    pub(super) set_bounds: SetBounds,
    pub(super) intervals: BlockIntervals,
    pub(super) interval_bounds: IntervalBounds,
    pub(super) block_ranges: BlockRanges,
    /// The votes of a block of 4 × 4 cells at each of [`HEADINGS`].
    pub(super) counts: Vec<Count>,
    pub(super) queue: BinaryHeap<Block>,
    /// Headings at which blocks of 8 × 8 cells may matter: the first, and a bit for each from
    /// there on.
    pub(super) windows: Vec<(usize, u64)>,
    /// Poses that matter.
    pub collector: Collector,
    /// Number of poses that were counted.
    pub poses_evaluated: u64,
    /// Most votes of any pose that the search did not reach because it was cut.
    pub left: u16,
    pub(super) tally: Tally,
}

impl Scratch {
    /// Prepares the buffers for a task; drops the contents of the one before.
    pub(super) fn start(&mut self, task: &Task<'_>) {
        let programs = task.programs;
        self.set_bounds.fit(&programs.sets, task.headings());
        self.block_ranges.prepare(task.grid, &task.space.directions);
        self.counts.resize(HEADINGS, Count::default());
        self.queue.clear();
        self.windows.clear();
        self.collector.start(task.config);
        self.poses_evaluated = 0;
        self.left = 0;
        self.tally = Tally::default();
    }
}
