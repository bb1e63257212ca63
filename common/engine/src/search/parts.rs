//! The parts of a search, each on a thread of its own.
//!
//! Threads share what is searched and the best pose so far, and each has a room
//! that stays with it from scan to scan.

use std::panic::resume_unwind;

use super::descent::{Descent, End, Room};
use super::task::Task;
use crate::votes::VoteSet;

/// Runs a search on as many threads as there are rooms, of which this is one.
pub(super) fn run(task: &Task<'_>, rooms: &mut [Room], stop: &dyn Fn() -> bool) -> End {
    let threads = rooms.len();
    let (own, others) = rooms.split_first_mut().expect("a thread");
    // A scope allocates, be it of no thread.
    if others.is_empty() {
        return Descent::new(task, own).run((0, 1), stop);
    }
    std::thread::scope(|scope| {
        let part =
            |(thread, room)| Descent::new(task, room).run((thread, threads), &|| task.is_stopped());
        let others = (1..).zip(others);
        let others = others.map(|own| scope.spawn(move || part(own)));
        let others: Vec<_> = others.collect();
        let own = Descent::new(task, own).run((0, threads), stop);
        if own != End::Done {
            task.stop();
        }
        let joined = others.into_iter().map(std::thread::ScopedJoinHandle::join);
        let joined = joined.map(|end| end.unwrap_or_else(|panic| resume_unwind(panic)));
        joined.fold(own, End::joined)
    })
}

/// What all threads found together.
pub(super) fn finish(rooms: &mut [Room], found: &mut VoteSet) {
    let (own, others) = rooms.split_first_mut().expect("a thread");
    for other in others {
        own.collector.merge(&other.collector);
        own.poses_evaluated += other.poses_evaluated;
    }
    own.collector.finish(own.poses_evaluated, found);
}
