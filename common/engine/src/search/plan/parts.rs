//! The parts of a search, each on a thread of its own, and searches of several maps.
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
    let run = |part, scratch: &mut Scratch, stop: &dyn Fn() -> bool| {
        let descent = Descent::new(task, scratch, (part, parts));
        match descent.run(stop) {
            End::Done => Ok(()),
            end => Err(end),
        }
    };
    threads::run(scratches, stop, run)
        .err()
        .unwrap_or(End::Done)
}

/// Searches maps together on one thread, each a part of its blocks: the next block is one of
/// the map on which the least was spent. As soon as the best pose is known, bounds of the
/// other maps are compared with its votes. How each map's search ended.
fn run_together(descents: &mut [Descent<'_>], ends: &mut [Option<End>], stop: &dyn Fn() -> bool) {
    let mut spent: f64 = 0.0;
    loop {
        let open = (0..descents.len()).filter(|&map| ends[map].is_none());
        let least = open.min_by(|&a, &b| descents[a].spent().total_cmp(&descents[b].spent()));
        let Some(map) = least else { return };
        let before = descents[map].spent();
        ends[map] = descents[map].step(spent - before, stop);
        spent += descents[map].spent() - before;
        if ends[map] == Some(End::Stopped) {
            return;
        }
    }
}

/// The same on as many threads as each map has scratch buffers; `None` if `stop` said so
/// before the end.
pub(in crate::search) fn run_all<'a>(
    maps: impl Iterator<Item = (&'a Task<'a>, &'a mut [Scratch])>,
    stop: &dyn Fn() -> bool,
) -> Option<Vec<End>> {
    /// What one thread searches.
    #[derive(Default)]
    struct Share<'a> {
        maps: Vec<(&'a Task<'a>, &'a mut Scratch)>,
        ends: Vec<Option<End>>,
    }
    let mut shares: Vec<Share<'a>> = Vec::new();
    for (task, scratches) in maps {
        shares.resize_with(scratches.len(), Share::default);
        for (share, scratch) in shares.iter_mut().zip(scratches) {
            share.maps.push((task, scratch));
            share.ends.push(None);
        }
    }
    let parts = shares.len();
    let run = |part, share: &mut Share<'a>, stop: &dyn Fn() -> bool| {
        let maps = share.maps.iter_mut();
        let mut descents: Vec<Descent<'_>> = maps
            .map(|(task, scratch)| Descent::new(task, scratch, (part, parts)))
            .collect();
        run_together(&mut descents, &mut share.ends, stop);
        let is_stopped = share.ends.contains(&Some(End::Stopped));
        if is_stopped { Err(()) } else { Ok(()) }
    };
    threads::run(&mut shares, stop, run).ok()?;
    let worst = |map| {
        let given_up = |share: &Share<'_>| share.ends[map] == Some(End::Hopeless);
        match shares.iter().any(given_up) {
            true => End::Hopeless,
            false => End::Done,
        }
    };
    Some((0..shares[0].ends.len()).map(worst).collect())
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
