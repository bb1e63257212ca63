//! Several maps that are searched together.

use super::attempt::Attempt;
use super::search::Workspace;
use crate::grid::Grid;
use crate::instruction_set::InstructionSet;
use crate::program::ScanProgram;
use crate::search::index::SearchIndex;
use crate::search::task::lead::Lead;
use crate::space::Space;
use crate::votes::{CollectConfig, VoteSet};

/// A map that is searched together with others.
#[derive(Debug)]
pub struct Searched<'a> {
    /// Index of the map.
    pub index: &'a SearchIndex,
    /// Cells of the map.
    pub grid: &'a Grid,
    /// Scan, compiled for the map's space.
    pub scan: (&'a ScanProgram, &'a Space),
    /// Workspace, which may have served other scans and maps.
    pub workspace: &'a mut Workspace,
    /// Poses that were found, filled in by the search.
    pub found: &'a mut VoteSet,
}

impl SearchIndex {
    /// Searches several maps together, each with a workspace and a place for the result. Finds
    /// on each map the poses that have at least a share of the best one's votes, on whichever
    /// map that is. Votes on different maps are compared as shares of the highest possible
    /// there, without rounding. The lead rises with them, and with poses that other searches
    /// find meanwhile. Returns `None` if `stop` returned true before the end.
    ///
    /// The outcome does not depend on the order of the maps, as far as it is certified. Of
    /// poses below the floor, a map that does not have the best pose has only those with at
    /// least half of its votes.
    ///
    /// # Panics
    /// If the processor does not have the instruction set, or there is no thread.
    pub fn search_together(
        maps: &mut [Searched<'_>],
        how: (InstructionSet, usize),
        (config, lead): (CollectConfig, &Lead),
        stop: &dyn Fn() -> bool,
    ) -> Option<()> {
        let attempts = maps.iter_mut().map(|map| {
            let (workspace, found) = (&mut *map.workspace, &mut *map.found);
            let together = (lead, stop);
            let attempt = map
                .index
                .attempt(workspace, how, map.grid, map.scan, config, together);
            (attempt, found)
        });
        let mut attempts: Vec<_> = attempts.collect();
        Attempt::find_all(&mut attempts, stop)
    }
}

#[cfg(test)]
mod tests {
    use proptest::collection::vec;
    use proptest::prelude::*;

    use super::*;
    use crate::testing::{any_grid, any_scan, plain_votes};
    use messages::Vote;

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
        let searched = maps.iter().zip(workspaces).zip(&mut found);
        let searched =
            searched.map(
                |((&(index, grid, program, space), workspace), found)| Searched {
                    index,
                    grid,
                    scan: (program, space),
                    workspace,
                    found,
                },
            );
        let mut searched: Vec<_> = searched.collect();
        SearchIndex::search_together(&mut searched, how, (config, &Lead::default()), &|| false)
            .unwrap();
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
