//! Votes of poses on maps with other cells, compared.

use std::cmp::Ordering;

/// The votes of a pose as a share of the highest possible on its map: a fraction of whole
/// numbers, so that maps are compared without rounding.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct VoteShare {
    /// Votes of the pose.
    pub votes: u16,
    /// What a pose of the map would have if every beam agreed fully; at least 1.
    pub possible: u16,
}

impl VoteShare {
    /// The share of a pose on a map with such a highest possible.
    #[must_use]
    pub fn new(votes: u16, possible: u16) -> Self {
        let possible = possible.max(1);
        VoteShare { votes, possible }
    }

    /// Which share is greater.
    #[must_use]
    pub fn compare(self, other: Self) -> Ordering {
        let product = |a: u16, b: u16| u32::from(a) * u32::from(b);
        product(self.votes, other.possible).cmp(&product(other.votes, self.possible))
    }

    /// The least number of votes that is as great a share of another highest possible.
    #[must_use]
    pub fn on(self, possible: u16) -> u16 {
        let product = u32::from(self.votes) * u32::from(possible);
        let votes = product.div_ceil(u32::from(self.possible.max(1)));
        u16::try_from(votes).unwrap_or(u16::MAX)
    }
}

impl Default for VoteShare {
    /// No votes.
    fn default() -> Self {
        VoteShare::new(0, 1)
    }
}
