//! Keeps the best pose.

/// A pose with its score.
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
        let at = |heading, y, x, score| Estimate {
            x,
            y,
            heading,
            score,
        };
        let mut best = Best::default();
        for estimate in [
            at(3, 0, 0, 1.0),
            at(2, 9, 9, 2.0),
            at(2, 9, 8, 2.0),
            at(4, 0, 0, 2.0),
        ] {
            best.take(estimate);
        }
        assert_eq!(best.get(), Some(at(2, 9, 8, 2.0)));
    }
}
