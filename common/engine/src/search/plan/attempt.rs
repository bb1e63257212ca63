//! One search: by bounds or, if these do not help, by counting every pose.

use super::alternatives;
use super::descent;
use super::parts;
use crate::search::counting;
use crate::search::task::{End, Task};
use crate::votes::{Distinct, VoteSet, is_close, least_close, most_candidates};

/// A search to be made, with a scratch buffer and a share for each of its threads.
pub(crate) struct Attempt<'a> {
    pub task: Task<'a>,
    pub scratches: &'a mut [descent::Scratch],
    pub alternatives: &'a mut alternatives::Scratch,
    pub shares: &'a mut [counting::Share],
    pub stop: &'a dyn Fn() -> bool,
}

impl Attempt<'_> {
    /// Finds the poses above the floor and candidates below, by bounds or by counting; `None`
    /// if it was asked to stop.
    pub(crate) fn find(&mut self, found: &mut VoteSet) -> Option<()> {
        let end = self.by_bounds(found);
        match end {
            End::Done => {}
            End::Stopped => return None,
            End::Hopeless => self.by_counting(found)?,
        }
        self.add_candidates(found);
        Some(())
    }

    /// Searches several maps together, each with a place for the result. Finds on each map the
    /// poses that have at least a share of the best one's votes, on whichever map that is. Votes
    /// on different maps are compared as shares of the highest possible there, without rounding.
    /// The lead rises with them, and with poses that other searches find meanwhile. Returns
    /// `None` if `stop` returned true before the end.
    ///
    /// The outcome does not depend on the order of the maps, as far as it is certified. Of
    /// poses below the floor, a map that does not have the best pose has only those with at
    /// least half of its votes.
    pub(crate) fn find_all(
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
    pub(crate) fn by_bounds(&mut self, found: &mut VoteSet) -> End {
        let end = parts::run(&self.task, self.scratches, self.stop);
        if end == End::Done {
            parts::finish(self.scratches, found);
        }
        end
    }

    /// Finds them by counting every pose; `None` if it was asked to stop.
    pub(crate) fn by_counting(&mut self, found: &mut VoteSet) -> Option<()> {
        counting::count(&self.task, self.shares, found, self.stop)
    }

    /// Adds the candidates that are wanted below the poses that were found.
    pub(crate) fn add_candidates(&mut self, found: &mut VoteSet) {
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
    use messages::Vote;
    use proptest::collection::vec;
    use proptest::prelude::*;

    use super::*;
    use crate::grid::Grid;
    use crate::instruction_set::InstructionSet;
    use crate::program::ScanProgram;
    use crate::search::Workspace;
    use crate::search::index::SearchIndex;
    use crate::search::task::lead::Lead;
    use crate::space::Space;
    use crate::testing::{
        any_grid, any_limited_grid, any_scan, plain_votes, plain_votes_within, space_of,
    };
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
            attempt.task.brute_force = f64::INFINITY;
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
                attempt.task.brute_force = 0.0;
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

    /// Returns the poses of maps that come near the best one of all, by counting every pose:
    /// most votes first, with the least that is complete.
    fn plain_together(
        maps: &[(&Grid, &ScanProgram, &Space)],
        config: CollectConfig,
    ) -> Vec<(Vec<Vote>, u16)> {
        let everything = CollectConfig {
            floor_share: 0.0,
            max_votes: u32::MAX,
            ..CollectConfig::exact()
        };
        let all = maps.iter().map(|(grid, program, space)| {
            let votes = plain_votes(grid, program, space, everything).votes;
            (votes, u64::from(program.highest_possible()).max(1))
        });
        let all: Vec<_> = all.collect();
        let best = |(votes, _): &(Vec<Vote>, u64)| {
            votes.first().map_or(0, |vote| u64::from(vote.intensity))
        };
        all.iter()
            .map(|(votes, possible)| {
                // As good as the best pose of each map.
                let lead = all
                    .iter()
                    .map(|other| (best(other) * possible).div_ceil(other.1));
                let floor = config.floor(lead.max().unwrap() as u16);
                let mut near = votes.clone();
                near.retain(|vote| vote.intensity >= floor);
                (near, floor)
            })
            .collect()
    }

    fn together(
        maps: &[(&SearchIndex, &Grid, &ScanProgram, &Space)],
        workspaces: &mut Vec<Workspace>,
        how: (InstructionSet, usize),
        config: CollectConfig,
    ) -> Vec<VoteSet> {
        workspaces.resize_with(maps.len(), Workspace::default);
        let mut found = vec![VoteSet::default(); maps.len()];
        let lead = Lead::default();
        let attempts = maps.iter().zip(workspaces).zip(&mut found);
        let attempts = attempts.map(|((&(index, grid, program, space), workspace), found)| {
            let scan = (program, space);
            let attempt = index.attempt(workspace, how, grid, scan, config, (&lead, &|| false));
            (attempt, found)
        });
        Attempt::find_all(&mut attempts.collect::<Vec<_>>(), &|| false).unwrap();
        found
    }

    proptest! {
        #[test]
        fn maps_that_are_searched_together_have_the_poses_near_the_best_of_all(
            worlds in vec((any_grid(), 1u32..4, 0.6..1.4f64), 1..5), scan in any_scan(),
            floor_share in 0.3..=1.0f64, candidates in 0u32..9, max_votes in prop_oneof![Just(65_536u32), 1u32..40],
        ) {
            // Cells of other sizes, so that other numbers of votes are possible.
            let space = |(grid, eights, scale): &(Grid, u32, f64)| {
                Space::new(8 * eights, 0.1 * scale, grid.width(), grid.height()).unwrap()
            };
            let reach_m = worlds.iter().map(|world| space(world).longest_m).fold(0.0, f64::max);
            let worlds: Vec<_> = worlds.into_iter().map(|world| {
                // Beams count on each that are too long for some.
                let (space, grid) = (space(&world).reaching(reach_m), world.0);
                let (index, program) = (SearchIndex::new(&grid, &space), scan.program(&space));
                (index, grid, program, space)
            }).collect();
            let maps: Vec<_> = worlds.iter().map(|(i, g, p, s)| (i, g, p, s)).collect();
            let plain: Vec<_> = maps.iter().map(|&(_, g, p, s)| (g, p, s)).collect();
            let config = CollectConfig { floor_share, candidates, max_votes, ..CollectConfig::default() };
            let plain = plain_together(&plain, config);
            let mut workspaces = Vec::new();
            for instruction_set in InstructionSet::available() {
                for threads in 1..3 {
                    let found = together(&maps, &mut workspaces, (instruction_set, threads), config);
                    for (found, (near, floor)) in found.iter().zip(&plain) {
                        let certain = |votes: &[Vote]| votes.iter().copied()
                            .filter(|vote| vote.intensity >= found.certified_floor).collect::<Vec<_>>();
                        prop_assert_eq!(certain(&found.votes), certain(near));
                        prop_assert!(found.certified_floor == *floor || found.truncated);
                        prop_assert!(found.certified_floor >= *floor && !found.cut);
                        if let Some(best) = near.first().filter(|_| near.len() <= max_votes as usize) {
                            prop_assert_eq!(found.votes.first(), Some(best));
                        }
                    }
                    let backward: Vec<_> = maps.iter().rev().copied().collect();
                    let mut backward = together(&backward, &mut workspaces, (instruction_set, threads), config);
                    backward.reverse();
                    for (found, other) in found.iter().zip(&backward) {
                        prop_assert_eq!(&found.votes, &other.votes);
                        prop_assert_eq!(found.certified_floor, other.certified_floor);
                    }
                }
            }
        }
    }
}
