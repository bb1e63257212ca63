//! Result of a search: the poses that have the most votes.

mod config;
mod distinct;
mod of_field;
mod share;

use std::cmp::Reverse;

use messages::Vote;

pub use config::CollectConfig;
pub use distinct::{DISTINCT_DEG, DISTINCT_M, distinct};
pub(crate) use distinct::{Distinct, is_close, least_close, most_candidates};
pub(crate) use of_field::FieldVotes;
pub use share::VoteShare;

/// The poses with the most votes, and the completeness of the list.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct VoteSet {
    /// Votes by falling intensity, equal ones by (heading, y, x). The first is the best pose; empty
    /// if no pose has a vote.
    pub votes: Vec<Vote>,
    /// Smallest intensity among them, including candidates below the certified floor; 0 if empty.
    pub floor: u16,
    /// All poses at or above this intensity are among the votes.
    pub certified_floor: u16,
    /// Highest intensity of any pose; with several maps, of those at or above the certified floor.
    pub best: u16,
    /// True if poses above the requested share were dropped for lack of room.
    pub truncated: bool,
    /// True if such poses may have been missed because the search reached its work limit. Then only
    /// poses at or above the certified floor are certain, and that floor can be above the best
    /// pose's votes.
    pub cut: bool,
    /// Number of poses whose intensity was computed one by one.
    pub poses_evaluated: u64,
}

impl VoteSet {
    /// Adds poses below the certified floor, best first, until there are enough distinct ones;
    /// empties `others`.
    pub(crate) fn add_candidates(&mut self, others: &mut Vec<Vote>, mut distinct: Distinct<'_>) {
        self.votes.iter().for_each(|vote| {
            distinct.take(vote);
        });
        others.retain(|vote| vote.intensity < self.certified_floor);
        others.sort_unstable_by_key(order);
        others.retain(|vote| distinct.take(vote));
        self.votes.append(others);
        self.floor = self.votes.last().map_or(0, |vote| vote.intensity);
    }

    /// Raises the certified floor if the best pose is on another map, and drops poses with fewer
    /// votes than the floor or, if given, than `least`. `best` is the number of votes on this map
    /// that equals the best pose's share, and `floor` the floor that follows from it.
    pub(crate) fn confine(&mut self, (best, floor): (u16, u16), least: Option<u16>) {
        if best <= self.best {
            return;
        }
        if floor >= self.certified_floor {
            (self.truncated, self.cut) = (false, false);
        }
        self.certified_floor = self.certified_floor.max(floor);
        let least = least.unwrap_or(self.certified_floor);
        self.votes.retain(|vote| vote.intensity >= least);
        self.take_range();
    }

    /// Reads the best intensity and the floor from the votes, which are sorted.
    fn take_range(&mut self) {
        self.best = self.votes.first().map_or(0, |vote| vote.intensity);
        self.floor = self.votes.last().map_or(0, |vote| vote.intensity);
    }

    /// Records that unseen poses have at most `left` votes.
    pub(crate) fn cut_at(&mut self, left: u16) {
        if left >= self.certified_floor {
            self.certified_floor = left.saturating_add(1);
            self.cut = true;
        }
    }

    /// Sorts the votes: after a search that was cut, candidates can be better than the poses found.
    pub(crate) fn put_in_order(&mut self) {
        if self.cut {
            self.votes.sort_unstable_by_key(order);
            self.take_range();
        }
    }
}

/// Takes poses in any order and keeps those that matter.
///
/// The result does not depend on the order: the floor only rises, and only to levels that the final
/// floor cannot be below.
#[derive(Debug, Default)]
pub(crate) struct Collector {
    config: CollectConfig,
    votes: Vec<Vote>,
    /// Most votes of any pose, including poses seen by other collectors.
    best: u16,
    /// Most votes of any pose taken.
    best_taken: u16,
    /// Intensity below which too many poses were seen for all to fit.
    crowded_below: u16,
    /// Best intensity, if not even all poses with it fit.
    cut: Option<u16>,
    /// Number of poses whose intensity was computed, taken or not.
    pub evaluated: u64,
}

impl Collector {
    #[cfg(test)]
    pub(crate) fn new(config: CollectConfig) -> Self {
        let mut collector = Collector::default();
        collector.start(config);
        collector
    }

    /// Starts again with the same buffers.
    pub(crate) fn start(&mut self, config: CollectConfig) {
        self.config = config;
        self.votes.clear();
        self.best = 0;
        self.best_taken = 0;
        self.crowded_below = 1;
        self.cut = None;
        self.evaluated = 0;
    }

    /// Smallest intensity that can still matter; at least 1.
    pub(crate) fn floor(&self) -> u16 {
        self.share_floor().max(self.crowded_below)
    }

    fn share_floor(&self) -> u16 {
        self.config.floor(self.best)
    }

    /// Takes a pose unless it is below the floor.
    pub(crate) fn take(&mut self, vote: Vote) {
        if vote.intensity < self.floor() {
            return;
        }
        self.best_taken = self.best_taken.max(vote.intensity);
        self.raise_best(vote.intensity);
        self.votes.push(vote);
        if self.votes.len() >= 2 * self.config.max_votes as usize {
            self.make_room();
        }
    }

    /// Takes the poses of an intensity image, row by row, at one heading.
    pub(crate) fn take_field(&mut self, field: &[u16], width: usize, heading: u16) {
        self.evaluated += field.len() as u64;
        for (y, row) in (0..).zip(field.chunks_exact(width)) {
            // Few rows contain a pose that matters, and a maximum is quick to compute.
            let floor = self.floor();
            if row.iter().copied().fold(0, u16::max) < floor {
                continue;
            }
            for (x, &intensity) in (0..).zip(row).filter(|&(_, &votes)| votes >= floor) {
                let vote = Vote {
                    x,
                    y,
                    heading,
                    intensity,
                };
                self.take(vote);
            }
        }
    }

    /// Raises the floor as a pose with `best` votes, seen by another collector, requires.
    pub(crate) fn raise_best(&mut self, best: u16) {
        self.best = self.best.max(best);
        if let Some(level) = self.cut.take_if(|level| *level < best) {
            // Some poses of that level were dropped, and it is no longer the best.
            self.crowded_below = self.crowded_below.max(level + 1);
        }
    }

    /// Most votes of any pose taken.
    pub(crate) fn best_taken(&self) -> u16 {
        self.best_taken
    }

    /// Merges another collector, as if one had taken the poses of both.
    fn merge(&mut self, other: &Collector) {
        self.evaluated += other.evaluated;
        self.crowded_below = self.crowded_below.max(other.crowded_below);
        self.raise_best(other.best);
        for &vote in &other.votes {
            self.take(vote);
        }
        self.cut = self.cut.max(other.cut);
        self.raise_best(self.best);
    }

    /// Merges the collectors of all threads into the first one, and moves its result to `outcome`.
    pub(crate) fn finish_all<'a>(
        mut collectors: impl Iterator<Item = &'a mut Collector>,
        outcome: &mut VoteSet,
    ) {
        let own = collectors.next().expect("a thread");
        collectors.for_each(|other| own.merge(other));
        own.finish(outcome);
    }

    /// Drops poses below the floor, then whole levels from below until the rest fits. The best
    /// level stays, cut to the number that fits.
    fn make_room(&mut self) {
        let max_votes = self.config.max_votes as usize;
        let floor = self.floor();
        self.votes.retain(|vote| vote.intensity >= floor);
        if self.votes.len() <= max_votes {
            return;
        }
        self.votes.sort_unstable_by_key(order);
        let first_left_out = self.votes[max_votes].intensity;
        self.crowded_below = first_left_out.saturating_add(1).min(self.best);
        let kept = self
            .votes
            .partition_point(|vote| vote.intensity >= self.crowded_below);
        self.cut = (kept > max_votes).then_some(self.best);
        self.votes.truncate(kept.min(max_votes));
    }

    /// Moves the result, sorted, to `outcome`. Votes are swapped, not copied: the old ones of the
    /// outcome become the next buffer.
    pub(crate) fn finish(&mut self, outcome: &mut VoteSet) {
        self.make_room();
        self.votes.sort_unstable_by_key(order);
        let best_is_cut = self.cut == Some(self.best);
        outcome.certified_floor = self.floor().saturating_add(u16::from(best_is_cut));
        outcome.truncated = best_is_cut || self.crowded_below > self.share_floor();
        outcome.cut = false;
        outcome.poses_evaluated = self.evaluated;
        std::mem::swap(&mut outcome.votes, &mut self.votes);
        outcome.take_range();
        self.votes.clear();
    }

    #[cfg(test)]
    pub(crate) fn finished(mut self) -> VoteSet {
        let mut outcome = VoteSet::default();
        self.finish(&mut outcome);
        outcome
    }
}

/// Sort key: most votes first, equal ones by (heading, y, x).
fn order(vote: &Vote) -> (Reverse<u16>, u16, u16, u16) {
    (Reverse(vote.intensity), vote.heading, vote.y, vote.x)
}

#[cfg(test)]
mod tests {
    use proptest::collection::vec;
    use proptest::prelude::*;

    use super::*;
    use crate::space::Space;
    use crate::testing::vote;

    fn collect(config: CollectConfig, intensities: &[u16]) -> VoteSet {
        let mut collector = Collector::new(config);
        for (x, &intensity) in (0..).zip(intensities) {
            collector.take(vote(x, 0, 0, intensity));
        }
        collector.finished()
    }

    fn levels(set: &VoteSet) -> Vec<u16> {
        set.votes.iter().map(|vote| vote.intensity).collect()
    }

    #[test]
    fn keeps_what_stands_above_the_share_of_the_best() {
        let config = CollectConfig {
            floor_share: 0.5,
            max_votes: 10,
            ..CollectConfig::exact()
        };
        let set = collect(config, &[3, 0, 10, 5, 4, 7]);
        assert_eq!(levels(&set), [10, 7, 5]);
        assert_eq!(
            (set.floor, set.certified_floor, set.best, set.truncated),
            (5, 5, 10, false)
        );
    }

    #[test]
    fn the_floor_rises_by_whole_levels() {
        let config = CollectConfig {
            floor_share: 0.0,
            max_votes: 4,
            ..CollectConfig::exact()
        };
        let set = collect(config, &[9, 8, 8, 7, 7, 6]);
        assert_eq!(levels(&set), [9, 8, 8]);
        assert_eq!(
            (set.floor, set.certified_floor, set.truncated),
            (8, 8, true)
        );
    }

    #[test]
    fn of_too_many_best_poses_the_first_are_kept() {
        let config = CollectConfig {
            floor_share: 1.0,
            max_votes: 2,
            ..CollectConfig::exact()
        };
        let set = collect(config, &[5; 9]);
        assert_eq!(
            set.votes.iter().map(|vote| vote.x).collect::<Vec<_>>(),
            [0, 1]
        );
        assert_eq!((set.best, set.certified_floor, set.truncated), (5, 6, true));
    }

    #[test]
    fn candidates_are_added_below_the_floor_while_distinct_ones_are_wanted() {
        let space = Space::new(360, 0.1, 100, 100).unwrap();
        let config = CollectConfig {
            floor_share: 0.9,
            ..CollectConfig::default()
        };
        let mut set = collect(config, &[10, 9, 3]);
        // The candidates are near the best; far; near that; turned by more than 6.5 degrees; too
        // many.
        let others = [(2, 3, 8), (9, 0, 5), (9, 6, 4), (0, 353, 7), (50, 0, 2)];
        let others = others.map(|(x, heading, intensity)| vote(x, 0, heading, intensity));
        let mut kept = Vec::new();
        let distinct = Distinct::new(&space, 3, &mut kept);
        set.add_candidates(&mut others.to_vec(), distinct);
        assert_eq!(levels(&set), [10, 9, 7, 5]);
        assert_eq!((set.floor, set.certified_floor), (5, 9));
    }

    #[test]
    fn no_votes_at_all_are_no_pose() {
        let set = collect(CollectConfig::default(), &[0, 0]);
        assert_eq!(set.votes, []);
        assert_eq!((set.best, set.floor, set.truncated), (0, 0, false));
    }

    proptest! {
        #[test]
        fn the_order_of_taking_does_not_matter(
            intensities in vec(0u16..12, 1..80), max_votes in 1u32..30, floor_share in 0.0..=1.0f64,
        ) {
            let config = CollectConfig { floor_share, max_votes, ..CollectConfig::exact() };
            let forward = collect(config, &intensities);
            let mut backward = Collector::new(config);
            for (x, &intensity) in intensities.iter().enumerate().rev() {
                backward.take(vote(x as u16, 0, 0, intensity));
            }
            let backward = backward.finished();
            prop_assert_eq!(&backward, &forward);
            // The result does not depend on the number of collectors either.
            let mut parts = [Collector::new(config), Collector::new(config), Collector::new(config)];
            for (x, &intensity) in intensities.iter().enumerate() {
                parts[x % 3].take(vote(x as u16, 0, 0, intensity));
            }
            let merge = |mut all: Collector, part| {
                all.merge(&part);
                all
            };
            let merged = parts.into_iter().reduce(merge).unwrap().finished();
            prop_assert_eq!(&merged, &forward);
            // The result is complete down to the certified floor.
            let certified = intensities.iter().filter(|&&i| i > 0 && i >= forward.certified_floor).count();
            let collected = forward.votes.iter().filter(|v| v.intensity >= forward.certified_floor).count();
            prop_assert_eq!(collected, certified);
        }
    }
}
