//! The best distinct poses, exactly.
//!
//! Distinct poses are picked by falling votes, each at least some way apart
//! from all before it; ties go to the lowest (heading, y, x). How low the last
//! of them lies is not known beforehand, and no sum of what was seen so far
//! bounds it: a better pose may push two others aside. So candidates give a
//! floor that rises with what is found, all poses above it are collected, and
//! where too few of them are distinct it stays low, and falls. Where bounds do not
//! help, it rises from nothing while every pose is counted.

use messages::Vote;

use super::descent::End;
use super::{SearchIndex, Workspace};
use crate::grid::Grid;
use crate::instruction_set::InstructionSet;
use crate::program::ScanProgram;
use crate::space::Space;
use crate::votes::{CollectConfig, Distinct, VoteSet};

/// Most poses that are collected at a time.
const MAX_VOTES: u32 = 1_000_000;

/// Candidates that the first floor comes of: some promise more than they have.
const GUESSES: u32 = 64;

/// How far the floor falls where too few poses are distinct.
const NEXT_FLOOR: f64 = 0.85;

/// The best distinct poses of a scan.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Top {
    /// Most votes first.
    pub poses: Vec<Vote>,
    /// Whether these are as many as were asked for, or all that have votes.
    /// Otherwise more than a million poses stand above the next one.
    pub is_complete: bool,
}

impl SearchIndex {
    /// The `count` distinct poses with the most votes, that is
    /// [`DISTINCT_M`](crate::votes::DISTINCT_M) or
    /// [`DISTINCT_DEG`](crate::votes::DISTINCT_DEG) apart; `None` if `stop`
    /// said so before the end.
    ///
    /// # Panics
    /// See [`SearchIndex::search_with`].
    #[must_use]
    pub fn top(
        &self,
        how: (InstructionSet, usize),
        grid: &Grid,
        scan: (&ScanProgram, &Space),
        count: usize,
        stop: &dyn Fn() -> bool,
    ) -> Option<Top> {
        let (mut workspace, mut found) = (Workspace::default(), VoteSet::default());
        let config = |floor_share, candidates| CollectConfig {
            floor_share,
            max_votes: MAX_VOTES,
            candidates,
        };
        let guessed = (config(1.0, GUESSES.max(count as u32)), 0);
        let mut guess = self.attempt(&mut workspace, how, grid, scan, guessed, stop);
        let end = guess.by_bounds(&mut found);
        let mut floor = match end {
            End::Done => {
                guess.add_candidates(end, &mut found);
                let best = Distinct::of(&found.votes, scan.1, count);
                match best.last() {
                    Some(last) if best.len() == count => f64::from(last.intensity),
                    _ => NEXT_FLOOR * f64::from(found.best),
                }
            }
            End::Stopped => return None,
            // The floor rises while poses are counted.
            End::Hopeless => 0.0,
        };
        let mut leading = count;
        loop {
            let share = floor / f64::from(found.best.max(1));
            let wanted = (config(share, 0), leading);
            let mut attempt = self.attempt(&mut workspace, how, grid, scan, wanted, stop);
            match end {
                End::Hopeless => attempt.by_counting(&mut found)?,
                _ => attempt.find(&mut found)?,
            }
            let top = top_of(&found, scan.1, count, floor < 1.0);
            if top.is_complete || (found.truncated && leading == 0) {
                return Some(top);
            }
            if found.truncated {
                // The floor rose too far, and poses that are wanted were left out.
                leading = 0;
                floor = floor.max(NEXT_FLOOR * f64::from(found.certified_floor));
            } else {
                floor *= NEXT_FLOOR;
            }
        }
    }
}

/// The best distinct ones of the poses that are certain to be complete.
fn top_of(found: &VoteSet, space: &Space, count: usize, is_all: bool) -> Top {
    let is_certain = |vote: &Vote| vote.intensity >= found.certified_floor;
    let certain = found.votes.partition_point(is_certain);
    let poses = Distinct::of(&found.votes[..certain], space, count);
    Top {
        is_complete: poses.len() == count || (is_all && !found.truncated),
        poses,
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::testing::{any_grid, any_scan, plain_votes, space_of};
    use crate::votes;

    proptest! {
        #[test]
        fn the_best_distinct_poses_are_those_of_the_reference(
            grid in any_grid(), scan in any_scan(), headings in 1u32..8, count in 1usize..20,
        ) {
            let space = space_of(&grid, headings * 8);
            let program = scan.program(&space);
            let all = CollectConfig { floor_share: 0.0, max_votes: MAX_VOTES, candidates: 0 };
            let all = plain_votes(&grid, &program, &space, all);
            prop_assert!(!all.truncated);
            // One by one, with nothing but the definition.
            let mut left = all.votes;
            let mut plain: Vec<Vote> = Vec::new();
            while plain.len() < count && !left.is_empty() {
                let best = left[0];
                plain.push(best);
                left.retain(|vote| !votes::are_near(vote, &best, &space));
            }
            let index = SearchIndex::new(&grid, &space);
            let how = (InstructionSet::best(), 1);
            let top = index.top(how, &grid, (&program, &space), count, &|| false).unwrap();
            prop_assert_eq!(top, Top { poses: plain, is_complete: true });
        }
    }
}
