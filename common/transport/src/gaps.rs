//! Losses, computed from the counters of the received samples.
//!
//! What is lost after the last sample shows only when another one comes.

/// Counts the samples of one publisher that never arrived. Pure: fed with the
/// counters of the stamps, in the order of arrival.
#[derive(Debug, Clone, Copy, Default)]
pub struct GapCounter {
    next: Option<u64>,
}

impl GapCounter {
    /// A counter that has seen nothing.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// The number of samples lost just before the one with `counter`.
    ///
    /// The first sample shows nothing, for one may join late; a counter at or
    /// below the last one belongs to a publisher that has started again.
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
