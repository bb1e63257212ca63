//! Counts every pose by sweeps, heading by heading, where bounds do not distinguish blocks.

use crate::accumulator::Query;
use crate::search::task::Task;
use crate::sweep;
use crate::threads;
use crate::votes::{Collector, VoteSet};

/// Buffers and results of one thread, kept from scan to scan.
#[derive(Debug, Default)]
pub(crate) struct Share {
    sweep: sweep::Workspace,
    field: Vec<u16>,
    collector: Collector,
    poses_evaluated: u64,
}

/// Finds the poses with the most votes, on as many threads as there are shares; `None` if
/// `stop` returned true before the end.
pub(crate) fn count(
    task: &Task<'_>,
    shares: &mut [Share],
    found: &mut VoteSet,
    stop: &dyn Fn() -> bool,
) -> Option<()> {
    let threads = shares.len();
    let counted = threads::run(shares, stop, |thread, share, stop| {
        share.collector.start(task.config);
        share.poses_evaluated = 0;
        let mut own = task.searched().skip(thread).step_by(threads);
        own.try_for_each(|heading| share.take(task, heading, stop))
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
    fn take(&mut self, task: &Task<'_>, heading: usize, stop: &dyn Fn() -> bool) -> Option<()> {
        let query = Query {
            program: task.program,
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
