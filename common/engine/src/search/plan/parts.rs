//! The parts of a search, each on a thread of its own, and searches of several maps.
//!
//! Threads share the task and the best pose so far, and each has a scratch of its own, kept
//! from scan to scan.

use super::descent::{Descent, Scratch};
use crate::search::task::{End, Task};
use crate::threads;
use crate::votes::{Collector, VoteSet};

/// Runs a search on as many threads as there are scratch buffers, the calling one included.
pub(crate) fn run(task: &Task<'_>, scratches: &mut [Scratch], stop: &dyn Fn() -> bool) -> End {
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

/// Searches one part of the blocks of each map on one thread. The next block is always one
/// of the map on which the least was spent. As soon as the best pose is known, bounds of
/// the other maps are compared with its votes. Fills in how each map's search ended.
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

/// Does the same on as many threads as each map has scratch buffers; `None` if `stop`
/// returned true before the end.
pub(crate) fn run_all<'a>(
    maps: impl Iterator<Item = (&'a Task<'a>, &'a mut [Scratch])>,
    stop: &dyn Fn() -> bool,
) -> Option<Vec<End>> {
    /// The work of one thread.
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

/// Merges the results of all threads.
pub(crate) fn finish(scratches: &mut [Scratch], found: &mut VoteSet) {
    let left = scratches.iter().map(|scratch| scratch.left).max();
    Collector::finish_all(scratches.iter_mut().map(|own| &mut own.collector), found);
    found.cut_at(left.unwrap_or(0));
}

/// Searches of two threads in every order that `loom` can tell apart.
#[cfg(all(test, loom))]
mod orders {
    use std::collections::BTreeMap;
    use std::sync::{Mutex, OnceLock};

    use loom::thread::Builder;

    use super::*;
    use crate::grid::{CellRules, Grid};
    use crate::instruction_set::InstructionSet;
    use crate::program::ScanProgram;
    use crate::search::index::SearchIndex;
    use crate::search::task::lead::Lead;
    use crate::simd::Simd;
    use crate::testing::{plain_votes, scan_from, space_of};
    use crate::votes::CollectConfig;

    /// Words of a thread's stack.
    const STACK: usize = 1 << 17;

    fn leak<T>(value: T) -> &'static T {
        Box::leak(Box::new(value))
    }

    /// Two rooms, one in the first quad of blocks and one in the second: each thread has one.
    /// The second is so wide that a pose there is near two walls at most.
    fn rooms() -> Grid {
        let (width, height) = (48, 16);
        let rooms = [(4..7, 4..7), (36..42, 4..10)];
        let is_free = |x: usize, y: usize| {
            rooms
                .iter()
                .any(|(xs, ys)| xs.contains(&x) && ys.contains(&y))
        };
        let cell = |i: usize| {
            if is_free(i % width, i / width) {
                0
            } else {
                100
            }
        };
        let occupancy: Vec<u8> = (0..width * height).map(cell).collect();
        Grid::new(width, height, &occupancy, CellRules::default()).unwrap()
    }

    /// In any order in which the threads find their poses and learn of each other's, the poses
    /// at or above the floor are those of the reference. In some orders, a thread skips poses
    /// that it counts in others.
    #[test]
    fn the_poses_that_are_found_are_the_same_in_any_order() {
        let grid = leak(rooms());
        let space = leak(space_of(grid, 8));
        let scan = scan_from(0.0, 1.5, &[0.2; 4]);
        let program = ScanProgram::new(&scan, 0.0, space, &Default::default()).unwrap();
        let config = CollectConfig::exact();
        let plain = plain_votes(grid, &program, space, config);
        assert!(!plain.votes.is_empty());
        let index = leak(SearchIndex::new(grid, space));
        assert!(index.coarse.quads() > 1, "each thread has a part");
        let (program, task) = (leak(program), leak(OnceLock::new()));
        let counted = leak(Mutex::new(BTreeMap::new()));
        loom::model(move || {
            let make = || {
                let (shared, simd) = (Box::leak(Box::default()), Simd::new(InstructionSet::best()));
                let how = (config, leak(Lead::default()));
                Task::new(shared, simd, index, grid, (program, space), how)
            };
            let task = leak(task.get_or_init(make).led_by(leak(Lead::default())));
            let search = |part| {
                move || {
                    let mut scratch = Scratch::default();
                    let end = Descent::new(task, &mut scratch, (part, 2)).run(&|| false);
                    assert_eq!(end, End::Done);
                    scratch
                }
            };
            // Its own stack is large enough for a search, as that of the model is not.
            let start = |part| {
                Builder::new()
                    .stack_size(STACK)
                    .spawn(search(part))
                    .unwrap()
            };
            let mut scratches = [start(0), start(1)].map(|thread| thread.join().unwrap());
            let mut found = VoteSet::default();
            finish(&mut scratches, &mut found);
            let mut counted = counted.lock().unwrap();
            *counted.entry(found.poses_evaluated).or_insert(0) += 1;
            found.poses_evaluated = 0;
            assert_eq!(found, plain);
        });
        let counted = counted.lock().unwrap();
        println!("orders, by the poses that were counted: {counted:?}");
        assert!(
            counted.len() > 1,
            "no thread spared another work: {counted:?}"
        );
    }
}
