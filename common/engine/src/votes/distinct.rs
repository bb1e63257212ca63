//! Selection of distinct candidate poses.

use messages::Vote;

use crate::space::Space;

/// Distance beyond which poses are distinct candidates, in metres; see also [`DISTINCT_DEG`].
pub const DISTINCT_M: f64 = 0.3;

/// Angle beyond which poses are distinct candidates, in degrees; see also [`DISTINCT_M`].
pub const DISTINCT_DEG: f64 = 6.5;

/// Factor by which poses close to the best in votes extend the wanted number of candidates. If many
/// poses have almost as many votes, votes do not decide which are the first.
const CLOSE_TIMES: usize = 4;

/// Largest number of candidates, including close ones, for a wanted number. If cells are larger
/// than the distance of distinct candidates, close ones are neighbours of one place and do not
/// extend the number.
pub(crate) fn most_candidates(wanted: usize, resolution_m: f64) -> usize {
    match resolution_m <= DISTINCT_M {
        true => CLOSE_TIMES * wanted,
        false => wanted,
    }
}

/// True if a pose is close to the best one in votes: it has at least half as many. This holds for
/// 28 of 29 true places, on three maps, that were among the first 256 but not among the first 64.
pub(crate) fn is_close(intensity: u16, best: u16) -> bool {
    2 * u32::from(intensity) >= u32::from(best)
}

/// Smallest number of votes that is close to the best.
pub(crate) fn least_close(best: u16) -> u16 {
    best.div_ceil(2).max(1)
}

/// Takes poses in order and keeps those distinct from all kept before, up to a maximum number.
#[derive(Debug)]
pub(crate) struct Distinct<'a> {
    space: &'a Space,
    wanted: usize,
    /// Votes of the best pose, if close poses extend the number.
    best: Option<u16>,
    kept: &'a mut Vec<Vote>,
}

impl<'a> Distinct<'a> {
    /// Keeps at most `wanted` poses, in a reused buffer.
    pub(crate) fn new(space: &'a Space, wanted: usize, kept: &'a mut Vec<Vote>) -> Self {
        kept.clear();
        Distinct {
            space,
            wanted,
            best: None,
            kept,
        }
    }

    /// Extends the number by poses close to the best one, see [`most_candidates`].
    pub(crate) fn and_close(self, best: u16) -> Self {
        Distinct {
            best: Some(best),
            ..self
        }
    }

    /// Takes a pose; returns true if it is kept.
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
}

/// Returns the distinct poses in their order, at most `wanted`: those more than [`DISTINCT_M`] or
/// [`DISTINCT_DEG`] apart from all before.
#[must_use]
pub fn distinct(votes: &[Vote], space: &Space, wanted: usize) -> Vec<Vote> {
    let mut kept = Vec::new();
    let mut distinct = Distinct::new(space, wanted, &mut kept);
    votes.iter().for_each(|vote| {
        distinct.take(vote);
    });
    kept
}

/// True if two poses are one candidate.
fn are_near(a: &Vote, b: &Vote, space: &Space) -> bool {
    let headings = space.directions.count() as u16;
    let turn = a.heading.abs_diff(b.heading);
    let degrees = f64::from(turn.min(headings - turn)) * 360.0 / f64::from(headings);
    let (dx, dy) = (f64::from(a.x.abs_diff(b.x)), f64::from(a.y.abs_diff(b.y)));
    dx.hypot(dy) * space.resolution_m <= DISTINCT_M && degrees <= DISTINCT_DEG
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::vote;

    #[test]
    fn of_poses_near_each_other_the_first_is_distinct() {
        let space = Space::new(360, 0.1, 100, 100).unwrap();
        let votes = [(0, 0), (2, 6), (4, 0), (0, 353), (4, 6), (50, 0), (60, 0)];
        let votes = votes.map(|(x, heading)| vote(x, 0, heading, 9));
        let found = distinct(&votes, &space, 4);
        let found: Vec<_> = found.iter().map(|vote| (vote.x, vote.heading)).collect();
        assert_eq!(found, [(0, 0), (4, 0), (0, 353), (50, 0)]);
    }
}
