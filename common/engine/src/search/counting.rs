//! Counts every pose by sweeps, heading by heading, where bounds do not distinguish blocks.

use crate::accumulator::Query;
use crate::program::ScanProgram;
use crate::search::task::Task;
use crate::sweep;
use crate::threads;
use crate::votes::{Collector, VoteSet};

/// Buffers and results of one thread, kept from scan to scan.
#[derive(Debug, Default)]
pub(in crate::parts::search) struct Share {
    sweep: sweep::Workspace,
    field: Vec<u16>,
    collector: Collector,
    poses_evaluated: u64,
}

/// Finds the poses with the most votes, on as many threads as there are shares; `None` if
/// `stop` returned true before the end.
pub(in crate::parts::search) fn count(
    (task, program): (&Task<'_>, &ScanProgram),
    shares: &mut [Share],
    found: &mut VoteSet,
    stop: &dyn Fn() -> bool,
) -> Option<()> {
    let threads = shares.len();
    let counted = threads::run(shares, stop, |thread, share, stop| {
        share.collector.start(task.config);
        share.poses_evaluated = 0;
        let mut own = task.searched().skip(thread).step_by(threads);
        own.try_for_each(|heading| share.take(task, program, heading, stop))
            .ok_or(())
    });
    counted.ok()?;
    let (own, others) = shares.split_first_mut().expect("a thread");
    for other in others {
        own.collector.merge(&other.collector);
        own.poses_evaluated += other.poses_evaluated;
    }
    own.collector.finish(own.poses_evaluated, found);
    Some(())
}

impl Share {
    /// Counts the poses of a heading.
    fn take(
        &mut self,
        task: &Task<'_>,
        program: &ScanProgram,
        heading: usize,
        stop: &dyn Fn() -> bool,
    ) -> Option<()> {
        let query = Query {
            program,
            space: task.space,
            heading,
        };
        let (field, simd) = (&mut self.field, task.programs.simd);
        let sweeps = task.index.sweeps(task.grid);
        sweeps.fill(simd, query, &mut self.sweep, field, stop)?;
        task.index.within.limits.clear(field, heading);
        self.collector.raise_best(task.best());
        self.collector
            .take_field(field, task.grid.width(), heading as u16);
        task.raise_best(self.collector.best_taken());
        self.poses_evaluated += field.len() as u64;
        Some(())
    }
}

#[cfg(test)]
mod tests {
    use proptest::collection::vec;
    use proptest::prelude::*;

    use super::*;
    use crate::instruction_set::InstructionSet;
    use crate::search::index::SearchIndex;
    use crate::search::task::Shared;
    use crate::search::task::lead::Lead;
    use crate::simd::Simd;
    use crate::testing::{any_limited_grid, any_scan, plain_votes_within, space_of};
    use crate::votes::CollectConfig;

    proptest! {
        #[test]
        fn counting_equals_the_reference_whatever_was_counted_before(
            worlds in vec((any_limited_grid(4), any_scan(), 1usize..4), 1..4),
            floor_share in 0.6..=1.0f64, max_votes in 1u32..400, is_known: bool,
        ) {
            let config = CollectConfig { floor_share, max_votes, ..CollectConfig::exact() };
            let (mut shared, mut shares) = (Shared::default(), Vec::new());
            let mut found = VoteSet::default();
            for ((grid, limits, headings), scan, threads) in worlds {
                let space = space_of(&grid, headings);
                let program = scan.program(&space);
                let plain = plain_votes_within(&limits, &grid, &program, &space, config);
                let index = SearchIndex::within(&grid, &space, limits);
                for set in InstructionSet::available() {
                    let lead = Lead::default();
                    let (simd, how) = (Simd::new(set), (config, &lead));
                    let task = Task::new(&mut shared, simd, &index, &grid, (&program, &space), how);
                    if is_known {
                        task.raise_best(plain.best);
                    }
                    shares.resize_with(threads, Share::default);
                    prop_assert!(count((&task, &program), &mut shares, &mut found, &|| false).is_some());
                    found.poses_evaluated = plain.poses_evaluated;
                    prop_assert_eq!(&found, &plain, "{}", set);
                }
            }
        }
    }
}
