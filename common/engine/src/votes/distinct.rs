//! Poses that are candidates of their own.

use messages::Vote;

use crate::space::Space;

/// Poses farther apart than this, or than [`DISTINCT_DEG`], are distinct
/// candidates, metres.
pub const DISTINCT_M: f64 = 0.3;

/// Poses farther apart than this, or than [`DISTINCT_M`], are distinct
/// candidates, degrees.
pub const DISTINCT_DEG: f64 = 6.5;

/// Where many poses have almost as many votes, votes do not tell which are the first:
/// beyond those that are wanted, poses close to the best are candidates as well, up to
/// so many times as many.
const CLOSE_TIMES: usize = 4;

/// Most candidates where so many are wanted: those and the ones that are close. Where
/// cells are larger than what tells candidates apart, the close ones are the neighbours
/// of one place, and are not counted.
pub(crate) fn most_candidates(wanted: usize, resolution_m: f64) -> usize {
    match resolution_m <= DISTINCT_M {
        true => CLOSE_TIMES * wanted,
        false => wanted,
    }
}

/// Whether a pose is close to the best one by votes: it has half as many. Of 29 true
/// places, on three maps, that were among the first 256 and not among 64, 28 were.
pub(crate) fn is_close(intensity: u16, best: u16) -> bool {
    2 * u32::from(intensity) >= u32::from(best)
}

/// Takes poses in order and keeps those that are distinct from all kept before,
/// at most so many.
#[derive(Debug)]
pub(crate) struct Distinct<'a> {
    space: &'a Space,
    wanted: usize,
    /// The votes of the best pose, where poses close to it are kept beyond those.
    best: Option<u16>,
    kept: &'a mut Vec<Vote>,
}

impl<'a> Distinct<'a> {
    /// Keeps none so far, of at most `wanted`, in the room of others before.
    pub(crate) fn new(space: &'a Space, wanted: usize, kept: &'a mut Vec<Vote>) -> Self {
        kept.clear();
        Distinct {
            space,
            wanted,
            best: None,
            kept,
        }
    }

    /// Keeps poses that are close to the best one beyond those that are wanted, see
    /// [`most_candidates`].
    pub(crate) fn and_close(self, best: u16) -> Self {
        Distinct {
            best: Some(best),
            ..self
        }
    }

    /// Whether the pose is kept.
    pub(crate) fn take(&mut self, vote: &Vote) -> bool {
        let near = |kept: &Vote| are_near(vote, kept, self.space);
        let is_new = self.has_room_for(vote) && !self.kept.iter().any(near);
        if is_new {
            self.kept.push(*vote);
        }
        is_new
    }

    fn has_room_for(&self, vote: &Vote) -> bool {
        let is_close = |best| is_close(vote.intensity, best);
        let kept = self.kept.len();
        let most = most_candidates(self.wanted, self.space.resolution_m);
        kept < self.wanted || kept < most && self.best.is_some_and(is_close)
    }

    /// Those of all poses.
    pub(crate) fn of(votes: &[Vote], space: &'a Space, wanted: usize) -> Vec<Vote> {
        let mut kept = Vec::new();
        let mut distinct = Distinct::new(space, wanted, &mut kept);
        votes.iter().for_each(|vote| {
            distinct.take(vote);
        });
        kept
    }
}

/// How many distinct poses are wanted, and the space in which they are told apart.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Leaders<'a> {
    pub wanted: usize,
    pub space: &'a Space,
}

/// The best distinct poses of those that came so far, in whatever order.
#[derive(Debug, Default)]
pub(crate) struct Leading {
    /// Most votes first.
    kept: Vec<Vote>,
}

impl Leading {
    /// Starts anew, with none.
    pub(crate) fn start(&mut self) {
        self.kept.clear();
    }

    /// Takes a pose. The votes of the last of the best ones wanted, where there are so
    /// many; a better pose that comes later may push two of them aside, so that is no
    /// bound of what the last one will have in the end.
    pub(crate) fn take(&mut self, vote: &Vote, leaders: Leaders<'_>) -> Option<u16> {
        let is_near = |kept: &Vote| are_near(vote, kept, leaders.space);
        let is_hidden = |kept: &Vote| kept.intensity >= vote.intensity && is_near(kept);
        if !self.kept.iter().any(is_hidden) {
            self.kept.retain(|kept| !is_near(kept));
            let place = |kept: &Vote| kept.intensity >= vote.intensity;
            let place = self.kept.partition_point(place);
            self.kept.insert(place, *vote);
            self.kept.truncate(leaders.wanted);
        }
        let is_full = self.kept.len() == leaders.wanted;
        self.kept
            .last()
            .filter(|_| is_full)
            .map(|vote| vote.intensity)
    }
}

/// Whether two poses are one candidate.
pub(crate) fn are_near(a: &Vote, b: &Vote, space: &Space) -> bool {
    let headings = space.directions.count() as u16;
    let turn = a.heading.abs_diff(b.heading);
    let degrees = f64::from(turn.min(headings - turn)) * 360.0 / f64::from(headings);
    let (dx, dy) = (f64::from(a.x.abs_diff(b.x)), f64::from(a.y.abs_diff(b.y)));
    dx.hypot(dy) * space.resolution_m <= DISTINCT_M && degrees <= DISTINCT_DEG
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_leading_poses_are_distinct_and_better_ones_push_others_aside() {
        let space = Space::new(360, 0.1, 100, 100).unwrap();
        let mut leading = Leading::default();
        let leaders = Leaders {
            wanted: 2,
            space: &space,
        };
        let mut last = |x, intensity| {
            let vote = Vote {
                x,
                y: 0,
                heading: 0,
                intensity,
            };
            leading.take(&vote, leaders)
        };
        assert_eq!(last(0, 5), None, "one of two");
        assert_eq!(last(2, 4), None, "beside a better one");
        assert_eq!(last(4, 6), Some(5));
        assert_eq!(last(50, 3), Some(5), "not among the best");
        assert_eq!(last(2, 7), None, "in place of both");
        assert_eq!(last(9, 1), Some(1));
        assert_eq!(last(51, 8), Some(7));
    }
}
