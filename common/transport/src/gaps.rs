//! Computes losses from the counters of received samples.

/// Counts the lost samples of one publisher from the counters of the stamps.
#[derive(Debug, Clone, Copy, Default)]
pub struct GapCounter {
    next: Option<u64>,
}

impl GapCounter {
    /// Returns the samples lost just before `counter`: 0 for the first one and after a restart.
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
        let mut gaps = GapCounter::default();
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
