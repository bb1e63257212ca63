//! Computes losses from the counters of the received samples.
//!
//! A loss after the last sample is only detected when another sample comes.

/// Counts the lost samples of one publisher. Pure: fed with the counters of the stamps, in the
/// order of arrival.
#[derive(Debug, Clone, Copy, Default)]
pub struct GapCounter {
    next: Option<u64>,
}

impl GapCounter {
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Returns the number of samples lost just before the one with `counter`.
    ///
    /// It is 0 for the first sample, as a subscriber may join late, and for a counter at or below
    /// the last one, as the publisher has restarted.
    pub fn lost_before(&mut self, counter: u64) -> u64 {
        let lost = self.next.map_or(0, |next| counter.saturating_sub(next));
        self.next = Some(counter.saturating_add(1));
        lost
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check(counters: &[u64], expected: &[u64]) {
        let mut gaps = GapCounter::new();
        let lost: Vec<u64> = counters.iter().map(|&c| gaps.lost_before(c)).collect();
        assert_eq!(lost, expected, "{counters:?}");
    }

    #[test]
    fn counts_gaps_but_neither_late_joining_nor_restarts() {
        check(&[0, 1, 2], &[0, 0, 0]);
        check(&[7, 8, 11, 12], &[0, 0, 2, 0]);
        check(&[5, 6, 0, 1, 3], &[0, 0, 0, 0, 1]);
        check(&[4, 4], &[0, 0]);
        check(&[u64::MAX, 0, u64::MAX], &[0, 0, u64::MAX - 1]);
    }
}
