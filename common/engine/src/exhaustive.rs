//! All headings by brute force: the field of each, one after the other.
//!
//! The baseline that the search must beat and is compared with. Several accumulators share the
//! headings, each on its own thread.

use std::sync::atomic::{AtomicU16, Ordering};

use crate::accumulator::{Accumulator, Query};
use crate::limits::Limits;
use crate::program::ScanProgram;
use crate::space::Space;
use crate::threads;
use crate::votes::{CollectConfig, Collector, VoteSet};

/// Finds the poses with the most votes over all headings; `None` if `stop` returned true before the
/// end.
///
/// Poses are searched within the limits, which must be those of the grid. The outcome does not
/// depend on the number of accumulators; the first one works on this thread.
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
    let (threads, best) = (accumulators.len(), AtomicU16::new(0));
    let shares = accumulators.iter_mut().map(Share::of);
    let mut shares: Vec<_> = shares.collect();
    threads::run(&mut shares, stop, |thread, share, stop| {
        let how = (config, &best, stop);
        let part = share.run((thread, threads), limits, (program, space), how);
        part.ok_or(())
    })
    .ok()?;
    let (own, others) = shares.split_first_mut().expect("a share");
    for other in others {
        own.collector.merge(&other.collector);
        own.poses += other.poses;
    }
    let mut found = VoteSet::default();
    own.collector.finish(own.poses, &mut found);
    Some(found)
}

/// Results and buffers of one thread.
#[derive(Debug)]
struct Share<'a, A> {
    accumulator: &'a mut A,
    field: Vec<u16>,
    collector: Collector,
    poses: u64,
}

impl<'a, A: Accumulator> Share<'a, A> {
    fn of(accumulator: &'a mut A) -> Self {
        Share {
            accumulator,
            field: Vec::new(),
            collector: Collector::default(),
            poses: 0,
        }
    }

    /// Counts the poses at every `threads`-th heading; threads share the highest number of votes of
    /// any pose.
    fn run(
        &mut self,
        (thread, threads): (usize, usize),
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
                self.accumulator.fill(query, &mut self.field, stop)?;
                self.collector.raise_best(best.load(Ordering::Relaxed));
                self.collect(limits, heading);
                best.fetch_max(self.collector.best_taken(), Ordering::Relaxed);
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
            let config = CollectConfig { floor_share, max_votes, ..CollectConfig::exact() };
            let sweeps = FieldSweep::new(&grid);
            let mut accumulators: Vec<_> = (0..threads).map(|_| sweeps.accumulator()).collect();
            let found = search(&mut accumulators, &Limits::none(grid.width()), (&program, &space), config, &|| false).unwrap();
            prop_assert_eq!(found.poses_evaluated, (grid.cells().len() * space.directions.count()) as u64);
            let found = VoteSet { poses_evaluated: 0, ..found };
            prop_assert_eq!(found, plain_votes(&grid, &program, &space, config));
        }
    }
}
