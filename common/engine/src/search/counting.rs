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
        let mut own = task.searched().skip(thread).step_by(threads);
        own.try_for_each(|heading| share.take(task, heading, stop))
            .ok_or(())
    });
    counted.ok()?;
    Collector::finish_all(shares.iter_mut().map(|share| &mut share.collector), found);
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
        let (field, simd) = (&mut self.field, task.shared.simd);
        let sweeps = task.index.sweeps(task.grid);
        sweeps.fill(simd, query, &mut self.sweep, field, stop)?;
        task.index.limits.clear(field, heading);
        self.collector.raise_best(task.best());
        self.collector
            .take_field(field, task.grid.width(), heading as u16);
        task.raise_best(self.collector.best_taken());
        Some(())
    }
}
