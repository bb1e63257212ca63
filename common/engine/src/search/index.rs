//! A map prepared for searches.

use std::panic::resume_unwind;

use super::alternatives::Alternatives;
use super::bins::Bins;
use super::descent::{Descent, End};
use super::intervals::RangeIntervals;
use super::set_bounds::SetProgram;
use super::sets::RangeSets;
use super::steps::BinSteps;
use super::task::Task;
use super::within::{Size, Within};
use crate::exhaustive;
use crate::grid::Grid;
use crate::instruction_set::InstructionSet;
use crate::limits::Limits;
use crate::program::ScanProgram;
use crate::space::Space;
use crate::sweep::FieldSweep;
use crate::votes::{CollectConfig, VoteSet};

/// Rows of the sets of 8 × 8 blocks stand for `1 << FINE_SHIFT` bins: a block
/// smears distances by more.
const FINE_SHIFT: u32 = 1;

/// A map prepared for searches: made once for each map.
#[derive(Debug, Clone)]
pub struct SearchIndex {
    pub(super) steps: BinSteps,
    pub(super) intervals: RangeIntervals,
    pub(super) fine: RangeSets,
    pub(super) coarse: RangeSets,
    pub(super) within: Within,
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

impl SearchIndex {
    /// Prepares a map.
    #[must_use]
    pub fn new(grid: &Grid, space: &Space) -> Self {
        let directions = &space.directions;
        let bins = Bins::new(directions);
        // No ray has more steps than it crosses columns or rows.
        let longest = grid.width().max(grid.height()) as u16;
        let intervals = RangeIntervals::new(grid, directions, &bins);
        let fine = RangeSets::new(&intervals, FINE_SHIFT);
        let coarse = fine.joined();
        SearchIndex {
            steps: BinSteps::new(&bins, directions, longest),
            intervals,
            fine,
            coarse,
            within: Within::new(Limits::none(grid.width())),
        }
    }

    /// The same map, of which poses are sought only within limits: those of its
    /// grid.
    #[must_use]
    pub fn within(mut self, limits: Limits) -> Self {
        self.within = Within::new(limits);
        self
    }

    /// Bytes that the index takes.
    #[must_use]
    pub fn bytes(&self) -> usize {
        self.intervals.bytes() + self.fine.bytes() + self.coarse.bytes()
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
        let best = InstructionSet::best();
        self.search_with((best, 1), grid, (program, space), config, stop)
    }

    /// The same with a certain instruction set on a number of threads, with the
    /// same outcome but for the number of poses that were counted. Where bounds
    /// cannot tell blocks apart, all poses are counted.
    ///
    /// # Panics
    /// If the processor does not have the instruction set, or there is no
    /// thread.
    #[must_use]
    pub fn search_with(
        &self,
        (instruction_set, threads): (InstructionSet, usize),
        grid: &Grid,
        scan: (&ScanProgram, &Space),
        config: CollectConfig,
        stop: &dyn Fn() -> bool,
    ) -> Option<VoteSet> {
        let task = Task::new(instruction_set.checked(), self, grid, scan, config);
        let mut found = match run(&task, threads, stop) {
            End::Done(collector, poses) => collector.finish(poses),
            End::Stopped => return None,
            End::Hopeless => {
                let how = (instruction_set, threads);
                count_all(how, (grid, &self.within.limits), scan, config, stop)?
            }
        };
        if config.candidates > 0 && found.best > 0 {
            let alternatives = Alternatives::new(&task).find(config.candidates as usize);
            found.add_candidates(alternatives, scan.1, config.candidates as usize);
        }
        Some(found)
    }

    /// Upper bounds of the intensities in all coarse blocks: where the robot
    /// may be, roughly.
    #[must_use]
    pub fn block_bounds(&self, program: &ScanProgram, space: &Space) -> BlockBounds {
        let (coarse, directions) = (&self.coarse, &space.directions);
        let best = InstructionSet::best();
        let set_program = SetProgram::new(program, directions, &self.steps, coarse.shift, best);
        let mut bounds = set_program.bounds(self.within.headings(directions.count()));
        let bound = |block| {
            if !self.within.holds(Size::Coarse, block) {
                return 0;
            }
            set_program.bound(coarse, block, 0, &mut bounds);
            bounds.greatest()
        };
        BlockBounds {
            side: coarse.side,
            columns: coarse.columns,
            bounds: (0..coarse.blocks()).map(bound).collect(),
        }
    }
}

/// Runs a search on a number of threads, of which this is one.
fn run(task: &Task<'_>, threads: usize, stop: &dyn Fn() -> bool) -> End {
    std::thread::scope(|scope| {
        let part = |thread| Descent::new(task).run((thread, threads), &|| task.is_stopped());
        let others = (1..threads).map(|thread| scope.spawn(move || part(thread)));
        let others: Vec<_> = others.collect();
        let own = Descent::new(task).run((0, threads), stop);
        if !matches!(own, End::Done(..)) {
            task.stop();
        }
        let joined = others.into_iter().map(std::thread::ScopedJoinHandle::join);
        let joined = joined.map(|end| end.unwrap_or_else(|panic| resume_unwind(panic)));
        joined.fold(own, End::joined)
    })
}

/// Counts every pose.
fn count_all(
    (instruction_set, threads): (InstructionSet, usize),
    (grid, limits): (&Grid, &Limits),
    scan: (&ScanProgram, &Space),
    config: CollectConfig,
    stop: &dyn Fn() -> bool,
) -> Option<VoteSet> {
    let sweeps = FieldSweep::new(grid);
    let accumulators = (0..threads).map(|_| sweeps.accumulator_with(instruction_set));
    let mut accumulators: Vec<_> = accumulators.collect();
    exhaustive::search(&mut accumulators, limits, scan, config, stop)
}

impl BlockBounds {
    /// Blocks along y.
    #[must_use]
    pub fn rows(&self) -> usize {
        self.bounds.len() / self.columns
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::super::budget::Cost;
    use super::*;
    use crate::reference;
    use crate::testing::{
        any_grid, any_limits, any_long_grid, any_scan, plain_votes, plain_votes_within, space_of,
    };
    use messages::Vote;

    fn any_limited_grid() -> impl Strategy<Value = (Grid, Limits, u32)> {
        (any_grid(), 1u32..8).prop_flat_map(|(grid, eighths)| {
            let limits = any_limits(&grid, 8 * eighths);
            (Just(grid), limits, Just(8 * eighths))
        })
    }

    fn check(
        grid: &Grid,
        (program, space): (&ScanProgram, &Space),
        config: CollectConfig,
    ) -> Result<(), TestCaseError> {
        let index = SearchIndex::new(grid, space);
        let plain = plain_votes(grid, program, space, config);
        for instruction_set in InstructionSet::available() {
            for threads in 1..4 {
                let how = (instruction_set, threads);
                let found = index.search_with(how, grid, (program, space), config, &|| false);
                let found = VoteSet {
                    poses_evaluated: 0,
                    ..found.unwrap()
                };
                prop_assert_eq!(&found, &plain, "{:?}", how);
            }
        }
        Ok(())
    }

    proptest! {
        #[test]
        fn the_search_equals_the_reference_however_it_is_done(
            grid in any_grid(), scan in any_scan(), headings in 1u32..8,
            floor_share in 0.5..=1.0f64, max_votes in 1u32..400,
        ) {
            let space = space_of(&grid, headings * 8);
            let config = CollectConfig { floor_share, max_votes, candidates: 0 };
            check(&grid, (&scan.program(&space), &space), config)?;
        }

        #[test]
        fn poses_beyond_the_limits_are_not_found(
            (grid, limits, headings) in any_limited_grid(), scan in any_scan(),
            floor_share in 0.3..=1.0f64, threads in 1usize..3, candidates in 0u32..9,
        ) {
            let space = space_of(&grid, headings);
            let program = scan.program(&space);
            let config = CollectConfig { floor_share, ..CollectConfig::default() };
            let plain = plain_votes_within(&limits, &grid, &program, &space, config);
            let index = SearchIndex::new(&grid, &space).within(limits.clone());
            let scan = (&program, &space);
            let config = CollectConfig { candidates, ..config };
            let how = (InstructionSet::best(), threads);
            let found = index.search_with(how, &grid, scan, config, &|| false).unwrap();
            let (above, below) = found.votes.split_at(plain.votes.len());
            prop_assert_eq!(above, &plain.votes);
            let is_held = |vote: &Vote| limits.hold_cell(vote.x.into(), vote.y.into())
                && limits.hold_heading(vote.heading.into());
            prop_assert!(below.iter().all(is_held));
            let counted = count_all(how, (&grid, &limits), scan, CollectConfig { candidates: 0, ..config }, &|| false);
            prop_assert_eq!(counted.unwrap().votes, plain.votes);
        }

        #[test]
        fn the_search_finds_far_readings_and_wide_tapers(
            grid in any_long_grid(), scan in any_scan(), floor_share in 0.5..=1.0f64,
        ) {
            let space = space_of(&grid, 16);
            let config = CollectConfig { floor_share, candidates: 0, ..CollectConfig::default() };
            check(&grid, (&scan.stretched(18.0).program(&space), &space), config)?;
        }

        #[test]
        fn candidates_are_poses_below_the_floor_and_the_same_however_it_is_done(
            grid in any_grid(), scan in any_scan(), headings in 1u32..8, candidates in 1u32..20,
        ) {
            let space = space_of(&grid, headings * 8);
            let program = scan.program(&space);
            let certain = CollectConfig { candidates: 0, ..CollectConfig::default() };
            let config = CollectConfig { candidates, ..certain };
            let index = SearchIndex::new(&grid, &space);
            let plain = plain_votes(&grid, &program, &space, certain);
            let mut first = None;
            for instruction_set in InstructionSet::available() {
                for threads in 1..3 {
                    let how = (instruction_set, threads);
                    let found = index.search_with(how, &grid, (&program, &space), config, &|| false).unwrap();
                    let found = VoteSet { poses_evaluated: 0, ..found };
                    let (above, below) = found.votes.split_at(plain.votes.len());
                    prop_assert_eq!(above, &plain.votes);
                    prop_assert!(below.len() <= candidates as usize);
                    for vote in below {
                        let (x, y) = (i64::from(vote.x), i64::from(vote.y));
                        let intensity = reference::intensity(&grid, &program, &space, x, y, vote.heading.into());
                        prop_assert_eq!(vote.intensity, intensity);
                        prop_assert!(grid.is_open(x, y) && intensity < found.certified_floor && intensity > 0);
                    }
                    prop_assert_eq!(first.get_or_insert(found.clone()), &found, "{:?}", how);
                }
            }
        }

        #[test]
        fn a_search_that_would_cost_too_much_gives_up_at_once(
            grid in any_grid(), scan in any_scan(), threads in 1usize..4,
        ) {
            let space = space_of(&grid, 64);
            let program = scan.program(&space);
            let (best, config) = (InstructionSet::best(), CollectConfig { candidates: 0, ..CollectConfig::default() });
            let index = SearchIndex::new(&grid, &space);
            let task = Task::new(best, &index, &grid, (&program, &space), config);
            let task = task.with_brute_force(Cost(0.0));
            // A search that is done after the first block has nothing to give up.
            match run(&task, threads, &|| false) {
                End::Done(collector, _) => {
                    let plain = plain_votes(&grid, &program, &space, config);
                    prop_assert_eq!(collector.finish(0), plain);
                }
                End::Hopeless => (),
                End::Stopped => prop_assert!(false, "nobody said stop"),
            }
        }

        #[test]
        fn no_pose_has_more_votes_than_the_bound_of_its_block(
            grid in any_grid(), scan in any_scan(), headings in 1u32..8, heading in 0usize..64,
        ) {
            let space = space_of(&grid, headings * 8);
            let program = scan.program(&space);
            let blocks = SearchIndex::new(&grid, &space).block_bounds(&program, &space);
            prop_assert_eq!(blocks.rows(), grid.height().div_ceil(blocks.side));
            let field = reference::field(&grid, &program, &space, heading % space.directions.count());
            for (i, &votes) in field.iter().enumerate() {
                let (x, y) = (i % grid.width(), i / grid.width());
                prop_assert!(votes <= blocks.bounds[y / blocks.side * blocks.columns + x / blocks.side]);
            }
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
        let index = SearchIndex::new(&grid, &space);
        let search =
            |stop| index.search(&grid, &program, &space, CollectConfig::default(), &|| stop);
        assert!(search(true).is_none());
        assert!(search(false).is_some());
    }
}
