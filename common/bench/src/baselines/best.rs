//! Keeps the best pose.

use messages::Vote;

#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Estimate {
    /// Column of the cell.
    pub x: usize,
    /// Row of the cell.
    pub y: usize,
    /// Index on the heading grid.
    pub heading: usize,
    /// Higher is better; the scale depends on the method.
    pub score: f32,
}

impl Estimate {
    pub(crate) fn new(x: usize, y: usize, heading: usize, score: f32) -> Self {
        Estimate {
            x,
            y,
            heading,
            score,
        }
    }
}

impl From<&Vote> for Estimate {
    fn from(vote: &Vote) -> Self {
        let (x, y, heading) = (vote.x.into(), vote.y.into(), vote.heading.into());
        Estimate::new(x, y, heading, vote.intensity.into())
    }
}

/// Keeps the best of poses in any order. Ties go to the lowest (heading, y, x), as in the engine.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Best(Option<Estimate>);

impl Best {
    pub(super) fn get(self) -> Option<Estimate> {
        self.0
    }

    /// Score to reach or exceed.
    pub(super) fn score(self) -> f32 {
        self.0.map_or(f32::NEG_INFINITY, |best| best.score)
    }

    pub(super) fn take(&mut self, estimate: Estimate) {
        let place = |estimate: &Estimate| (estimate.heading, estimate.y, estimate.x);
        let is_better = self.0.is_none_or(|best| {
            estimate.score > best.score
                || (estimate.score == best.score && place(&estimate) < place(&best))
        });
        if is_better {
            self.0 = Some(estimate);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ties_go_to_the_first_place() {
        let mut best = Best::default();
        for (heading, y, x, score) in [
            (3, 0, 0, 1.0),
            (2, 9, 9, 2.0),
            (2, 9, 8, 2.0),
            (4, 0, 0, 2.0),
        ] {
            best.take(Estimate::new(x, y, heading, score));
        }
        assert_eq!(best.get(), Some(Estimate::new(8, 9, 2, 2.0)));
    }
}
