//! The parts of a search, each on a thread of its own.
//!
//! Threads share what is searched and the best pose so far, and each has a scratch
//! that stays with it from scan to scan.

use super::descent::{Descent, Scratch};
use crate::search::task::{End, Task};
use crate::threads;
use crate::votes::VoteSet;

/// Runs a search on as many threads as there are scratch buffers, of which this is one.
pub(in crate::search) fn run(
    task: &Task<'_>,
    scratches: &mut [Scratch],
    stop: &dyn Fn() -> bool,
) -> End {
    let parts = scratches.len();
    let run =
        |part, scratch: &mut Scratch, stop: &dyn Fn() -> bool| match Descent::new(task, scratch)
            .run((part, parts), stop)
        {
            End::Done => Ok(()),
            end => Err(end),
        };
    threads::run(scratches, stop, run)
        .err()
        .unwrap_or(End::Done)
}

/// What all threads found together.
pub(in crate::search) fn finish(scratches: &mut [Scratch], found: &mut VoteSet) {
    let (own, others) = scratches.split_first_mut().expect("a thread");
    for other in others {
        own.collector.merge(&other.collector);
        own.poses_evaluated += other.poses_evaluated;
        own.left = own.left.max(other.left);
    }
    own.collector.finish(own.poses_evaluated, found);
    found.cut_at(own.left);
}
