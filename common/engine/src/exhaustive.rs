//! All headings by brute force: the field of each, one after the other.
//!
//! What the search must beat, and what it is compared with. Several
//! accumulators share the headings, each on a thread of its own.

use std::panic::resume_unwind;
use std::sync::atomic::{AtomicBool, Ordering};

use crate::accumulator::{Accumulator, Query};
use crate::limits::Limits;
use crate::program::ScanProgram;
use crate::space::Space;
use crate::votes::{CollectConfig, Collector, VoteSet};

/// The poses with the most votes over all headings; `None` if `stop` said so
/// before the end.
///
/// Poses are sought within the limits, which are those of the grid. The outcome does not depend on how many
/// accumulators there are; the first one works on this thread.
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
    let step = accumulators.len();
    let (own, others) = accumulators.split_first_mut().expect("an accumulator");
    let fill = |first: usize, accumulator: &mut A, stop: &dyn Fn() -> bool| {
        let mut share = Share::new(config);
        for heading in (first..space.directions.count()).step_by(step) {
            let query = Query {
                program,
                space,
                heading,
            };
            if limits.hold_heading(heading) {
                accumulator.fill(query, &mut share.field, stop)?;
                share.collect(limits, heading);
            }
        }
        Some(share)
    };
    let stopped = AtomicBool::new(false);
    let is_stopped = || stopped.load(Ordering::Relaxed);
    let shares: Option<Vec<Share>> = std::thread::scope(|scope| {
        let spawn =
            |(first, accumulator)| scope.spawn(move || fill(first, accumulator, &is_stopped));
        let threads: Vec<_> = (1..).zip(others).map(spawn).collect();
        let own = fill(0, own, stop);
        stopped.store(own.is_none(), Ordering::Relaxed);
        let joined = threads.into_iter().map(std::thread::ScopedJoinHandle::join);
        let joined = joined.map(|share| share.unwrap_or_else(|panic| resume_unwind(panic)));
        std::iter::once(own).chain(joined).collect()
    });
    let all = shares?.into_iter().reduce(Share::merged)?;
    Some(all.collector.finish(all.poses))
}

/// What one accumulator found.
struct Share {
    field: Vec<u16>,
    collector: Collector,
    poses: u64,
}

impl Share {
    fn new(config: CollectConfig) -> Self {
        Share {
            field: Vec::new(),
            collector: Collector::new(config),
            poses: 0,
        }
    }

    fn collect(&mut self, limits: &Limits, heading: usize) {
        self.poses += self.field.len() as u64;
        limits.clear(&mut self.field, heading);
        self.collector
            .take_field(&self.field, limits.width(), heading as u16);
    }

    fn merged(self, other: Share) -> Share {
        Share {
            field: self.field,
            collector: self.collector.merged(other.collector),
            poses: self.poses + other.poses,
        }
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
