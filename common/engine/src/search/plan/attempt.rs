//! One search: by bounds or, if these do not help, by counting every pose.

use super::alternatives;
use super::descent;
use super::parts;
use crate::program::ScanProgram;
use crate::search::counting;
use crate::search::task::{End, Task};
use crate::votes::{Distinct, VoteSet, is_close, least_close, most_candidates};

/// A search to be made, with a scratch buffer and a share for each of its threads.
pub(in crate::parts::search) struct Attempt<'a> {
    pub task: Task<'a>,
    pub program: &'a ScanProgram,
    pub scratches: &'a mut [descent::Scratch],
    pub alternatives: &'a mut alternatives::Scratch,
    pub shares: &'a mut [counting::Share],
    pub stop: &'a dyn Fn() -> bool,
}

impl Attempt<'_> {
    /// Finds the poses above the floor and candidates below, by bounds or by counting; `None`
    /// if it was asked to stop.
    pub(in crate::parts::search) fn find(&mut self, found: &mut VoteSet) -> Option<()> {
        let end = self.by_bounds(found);
        match end {
            End::Done => {}
            End::Stopped => return None,
            End::Hopeless => self.by_counting(found)?,
        }
        self.add_candidates(found);
        Some(())
    }

    /// Finds the poses of several maps that are searched together: on each map, those that come
    /// near the best one of all.
    pub(in crate::parts::search) fn find_all(
        maps: &mut [(Self, &mut VoteSet)],
        stop: &dyn Fn() -> bool,
    ) -> Option<()> {
        let searched = maps.iter_mut();
        let searched = searched.map(|(map, _)| (&map.task, &mut *map.scratches));
        let ends = parts::run_all(searched, stop)?;
        for ((map, found), end) in maps.iter_mut().zip(&ends) {
            // The best pose is likely known by now, and most poses need not be counted.
            match end {
                End::Hopeless => map.by_counting(found)?,
                _ => parts::finish(map.scratches, found),
            }
        }
        for (map, found) in maps {
            let best = map.task.best();
            found.confine((best, map.task.config.floor(best)), None);
            map.add_candidates(found);
        }
        Some(())
    }

    /// Finds the poses above the floor by bounds, unless that is hopeless.
    pub(in crate::parts::search) fn by_bounds(&mut self, found: &mut VoteSet) -> End {
        let end = parts::run(&self.task, self.scratches, self.stop);
        if end == End::Done {
            parts::finish(self.scratches, found);
        }
        end
    }

    /// Finds them by counting every pose; `None` if it was asked to stop.
    pub(in crate::parts::search) fn by_counting(&mut self, found: &mut VoteSet) -> Option<()> {
        let what = (&self.task, self.program);
        counting::count(what, self.shares, found, self.stop)
    }

    /// Adds the candidates that are wanted below the poses that were found.
    pub(in crate::parts::search) fn add_candidates(&mut self, found: &mut VoteSet) {
        let Self {
            task, alternatives, ..
        } = self;
        let (wanted, best) = (task.config.candidates as usize, task.best());
        // If another map has the best pose, only candidates close to it are wanted.
        let least = match found.best == best {
            true => 1,
            false => least_close(best),
        };
        if wanted > 0 && best > 0 {
            let certain = found.votes.len();
            let most = most_candidates(wanted, task.space.resolution_m);
            for count in [wanted, most] {
                found.votes.truncate(certain);
                alternatives.find(task, count, least);
                let distinct = Distinct::new(task.space, wanted, &mut alternatives.distinct);
                let distinct = distinct.and_close(best);
                alternatives.votes.retain(|vote| vote.intensity >= least);
                found.add_candidates(&mut alternatives.votes, distinct);
                let kept = alternatives.distinct.iter();
                let close = kept.filter(|vote| is_close(vote.intensity, best));
                if most == wanted || 2 * close.count() < wanted {
                    break;
                }
            }
            found.put_in_order();
        }
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::instruction_set::InstructionSet;
    use crate::search::Workspace;
    use crate::search::index::SearchIndex;
    use crate::search::task::budget::Cost;
    use crate::search::task::lead::Lead;
    use crate::testing::{any_limited_grid, any_scan, plain_votes_within, space_of};
    use crate::votes::CollectConfig;

    proptest! {
        #[test]
        fn candidates_are_the_same_where_the_search_was_given_up(
            (grid, limits, headings) in any_limited_grid(8), scan in any_scan(),
            threads in 1usize..4, candidates in 1u32..40,
        ) {
            let space = space_of(&grid, headings);
            let program = scan.program(&space);
            let config = CollectConfig { candidates, ..CollectConfig::default() };
            let index = SearchIndex::within(&grid, &space, limits);
            let (mut workspace, lead) = (Workspace::default(), Lead::default());
            let (how, scan) = ((InstructionSet::best(), threads), (&program, &space));
            let mut attempt = index.attempt(&mut workspace, how, &grid, scan, config, (&lead, &|| false));
            attempt.task.brute_force = Cost(f64::INFINITY);
            let mut found = VoteSet::default();
            prop_assert_eq!(attempt.by_bounds(&mut found), End::Done);
            let mut given_up = found.clone();
            attempt.add_candidates(&mut found);
            attempt.add_candidates(&mut given_up);
            prop_assert_eq!(found, given_up);
        }

        #[test]
        fn a_search_that_would_cost_too_much_gives_up_and_counting_equals_the_reference(
            (grid, limits, headings) in any_limited_grid(8), scan in any_scan(), threads in 1usize..4,
            floor_share in 0.6..=1.0f64, max_votes in 1u32..400,
        ) {
            let space = space_of(&grid, headings);
            let program = scan.program(&space);
            let config = CollectConfig { floor_share, max_votes, ..CollectConfig::exact() };
            let plain = plain_votes_within(&limits, &grid, &program, &space, config);
            let index = SearchIndex::within(&grid, &space, limits);
            let (mut workspace, scan) = (Workspace::default(), (&program, &space));
            let mut found = VoteSet::default();
            for set in InstructionSet::available() {
                let lead = Lead::default();
                let mut attempt =
                    index.attempt(&mut workspace, (set, threads), &grid, scan, config, (&lead, &|| false));
                attempt.task.brute_force = Cost(0.0);
                // A search that is done after the first block has nothing to give up.
                match attempt.by_bounds(&mut found) {
                    End::Done => (),
                    End::Hopeless => prop_assert!(attempt.by_counting(&mut found).is_some()),
                    End::Stopped => prop_assert!(false, "nothing said stop"),
                }
                prop_assert_eq!(VoteSet { poses_evaluated: 0, ..found.clone() }, plain.clone());
                prop_assert!(attempt.find(&mut found).is_some());
                prop_assert_eq!(VoteSet { poses_evaluated: 0, ..found.clone() }, plain.clone());
            }
        }
    }
}
