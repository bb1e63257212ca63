//! All headings by brute force: the field of each, one after the other.
//!
//! What the search must beat, and what it is compared with. Several
//! accumulators share the headings, each on a thread of its own.

use std::panic::resume_unwind;
use std::sync::atomic::{AtomicBool, AtomicU16, Ordering};

use crate::accumulator::{Accumulator, Query};
use crate::limits::Limits;
use crate::program::ScanProgram;
use crate::space::Space;
use crate::votes::{CollectConfig, Collector, VoteSet};

/// The poses with the most votes over all headings; `None` if `stop` said so
/// before the end.
///
/// Poses are sought within the limits, which are those of the grid. The outcome
/// does not depend on how many accumulators there are; the first one works on
/// this thread.
///
/// # Panics
/// If there is no accumulator, or one of them panics.
#[must_use]
pub fn search<A: Accumulator + Send>(
    accumulators: &mut [A],
    limits: &Limits,
    (program, space): (&ScanProgram, &Space),
    config: CollectConfig,
    stop: &dyn Fn() -> bool,
) -> Option<VoteSet> {
    let shares = accumulators.iter_mut().map(Share::of);
    let mut shares: Vec<_> = shares.collect();
    let fill = |accumulator: &mut &mut A,
                query: Query<'_>,
                field: &mut Vec<u16>,
                stop: &dyn Fn() -> bool| accumulator.fill(query, field, stop);
    let mut found = VoteSet::default();
    let collect = (config, 0, &mut found);
    count(&mut shares, fill, limits, (program, space), collect, stop)?;
    Some(found)
}

/// The same by any way to fill in the intensities of all cells at a heading,
/// one thread a share; the shares may have served other scans and maps. Some pose is
/// known to have `best` votes.
///
/// # Panics
/// If there is no share.
pub(crate) fn count<T: Send>(
    shares: &mut [Share<T>],
    fill: impl Fn(&mut T, Query<'_>, &mut Vec<u16>, &dyn Fn() -> bool) -> Option<()> + Sync,
    limits: &Limits,
    scan: (&ScanProgram, &Space),
    (config, best, found): (CollectConfig, u16, &mut VoteSet),
    stop: &dyn Fn() -> bool,
) -> Option<()> {
    let (threads, best) = (shares.len(), AtomicU16::new(best));
    let run = |thread: usize, share: &mut Share<T>, stop: &dyn Fn() -> bool| {
        let how = (config, &best, stop);
        share.run((thread, threads), &fill, limits, scan, how)
    };
    let (own, others) = shares.split_first_mut().expect("a share");
    let outcome = if others.is_empty() {
        run(0, own, stop)
    } else {
        let stopped = AtomicBool::new(false);
        let is_stopped = || stopped.load(Ordering::Relaxed);
        std::thread::scope(|scope| {
            let spawn = |(thread, share)| scope.spawn(move || run(thread, share, &is_stopped));
            let threads: Vec<_> = (1..).zip(&mut *others).map(spawn).collect();
            let own = run(0, own, stop);
            stopped.store(own.is_none(), Ordering::Relaxed);
            let joined = threads.into_iter().map(std::thread::ScopedJoinHandle::join);
            let joined = joined.map(|share| share.unwrap_or_else(|panic| resume_unwind(panic)));
            joined.fold(own, Option::and)
        })
    };
    outcome?;
    for other in others {
        own.collector.merge(&other.collector);
        own.poses += other.poses;
    }
    own.collector.finish(own.poses, found);
    Some(())
}

/// What one thread finds, and what it finds it with.
#[derive(Debug, Default)]
pub(crate) struct Share<T> {
    tool: T,
    field: Vec<u16>,
    collector: Collector,
    poses: u64,
}

impl<T> Share<T> {
    fn of(tool: T) -> Self {
        Share {
            tool,
            field: Vec::new(),
            collector: Collector::default(),
            poses: 0,
        }
    }

    /// Counts the poses at every `threads`-th heading; threads tell each other the most
    /// votes of any pose.
    fn run(
        &mut self,
        (thread, threads): (usize, usize),
        fill: &impl Fn(&mut T, Query<'_>, &mut Vec<u16>, &dyn Fn() -> bool) -> Option<()>,
        limits: &Limits,
        (program, space): (&ScanProgram, &Space),
        (config, best, stop): (CollectConfig, &AtomicU16, &dyn Fn() -> bool),
    ) -> Option<()> {
        self.collector.start(config);
        self.poses = 0;
        for heading in (thread..space.directions.count()).step_by(threads) {
            let query = Query {
                program,
                space,
                heading,
            };
            if limits.hold_heading(heading) {
                fill(&mut self.tool, query, &mut self.field, stop)?;
                self.collector.hear_of(best.load(Ordering::Relaxed));
                self.collect(limits, heading);
                best.fetch_max(self.collector.best(), Ordering::Relaxed);
            }
        }
        Some(())
    }

    fn collect(&mut self, limits: &Limits, heading: usize) {
        self.poses += self.field.len() as u64;
        limits.clear(&mut self.field, heading);
        self.collector
            .take_field(&self.field, limits.width(), heading as u16);
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::sweep::FieldSweep;
    use crate::testing::{any_grid, any_scan, plain_votes, space_of};

    proptest! {
        #[test]
        fn any_number_of_threads_finds_what_the_reference_does(
            grid in any_grid(), scan in any_scan(), headings in 1u32..6, threads in 1usize..4,
            floor_share in 0.0..=1.0f64, max_votes in 1u32..400,
        ) {
            let space = space_of(&grid, headings * 8);
            let program = scan.program(&space);
            let config = CollectConfig { floor_share, max_votes, candidates: 0 };
            let sweeps = FieldSweep::new(&grid);
            let mut accumulators: Vec<_> = (0..threads).map(|_| sweeps.accumulator()).collect();
            let found = search(&mut accumulators, &Limits::none(grid.width()), (&program, &space), config, &|| false).unwrap();
            prop_assert_eq!(found.poses_evaluated, (grid.cells().len() * space.directions.count()) as u64);
            let found = VoteSet { poses_evaluated: 0, ..found };
            prop_assert_eq!(found, plain_votes(&grid, &program, &space, config));
        }
    }
}
