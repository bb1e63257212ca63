//! The parts of a search, each on a thread of its own.
//!
//! Threads share what is searched and the best pose so far, and each has a room
//! that stays with it from scan to scan.

use super::descent::{Descent, Room};
use crate::search::task::{End, Task};
use crate::threads;
use crate::votes::VoteSet;

/// Runs a search on as many threads as there are rooms, of which this is one.
pub(in crate::search) fn run(task: &Task<'_>, rooms: &mut [Room], stop: &dyn Fn() -> bool) -> End {
    let parts = rooms.len();
    let run = |part, room: &mut Room, stop: &dyn Fn() -> bool| match Descent::new(task, room)
        .run((part, parts), stop)
    {
        End::Done => Ok(()),
        end => Err(end),
    };
    threads::run(rooms, stop, run).err().unwrap_or(End::Done)
}

/// What all threads found together.
pub(in crate::search) fn finish(rooms: &mut [Room], found: &mut VoteSet) {
    let (own, others) = rooms.split_first_mut().expect("a thread");
    for other in others {
        own.collector.merge(&other.collector);
        own.poses_evaluated += other.poses_evaluated;
        own.left = own.left.max(other.left);
    }
    own.collector.finish(own.poses_evaluated, found);
    found.cut_at(own.left);
}
