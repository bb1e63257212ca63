//! Comparison of votes on maps with different cells.

use std::cmp::Ordering;

/// Votes of a pose as a share of the highest possible on its map: a fraction of integers, so that
/// maps are compared without rounding.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct VoteShare {
    /// Votes of the pose.
    pub votes: u16,
    /// Votes of a pose with which every beam agrees fully; at least 1.
    pub possible: u16,
}

impl VoteShare {
    /// Makes the share of a pose on a map with this highest possible number of votes.
    #[must_use]
    pub fn new(votes: u16, possible: u16) -> Self {
        let possible = possible.max(1);
        VoteShare { votes, possible }
    }

    /// Compares two shares exactly.
    #[must_use]
    pub fn compare(self, other: Self) -> Ordering {
        let product = |a: u16, b: u16| u32::from(a) * u32::from(b);
        product(self.votes, other.possible).cmp(&product(other.votes, self.possible))
    }

    /// Returns the smallest number of votes that is at least this share of another highest
    /// possible.
    #[must_use]
    pub fn on(self, possible: u16) -> u16 {
        let product = u32::from(self.votes) * u32::from(possible);
        let votes = product.div_ceil(u32::from(self.possible.max(1)));
        u16::try_from(votes).unwrap_or(u16::MAX)
    }
}

impl Default for VoteShare {
    /// The share without votes.
    fn default() -> Self {
        VoteShare::new(0, 1)
    }
}
