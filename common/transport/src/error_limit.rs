//! Limits the rate of logged errors.
//!
//! Pure: the caller passes the time. The first error is logged at once, further ones at most once
//! per second with the number of those suppressed.

/// Least time between two logged errors, nanoseconds.
const PERIOD_NS: i64 = 1_000_000_000;

#[derive(Debug, Default)]
pub struct ErrorLimit {
    last_ns: Option<i64>,
    held_back: u64,
}

impl ErrorLimit {
    /// Counts an error at `now_ns`; returns the number of errors suppressed before it if it should
    /// be logged, else `None`.
    pub fn note(&mut self, now_ns: i64) -> Option<u64> {
        if self.last_ns.is_some_and(|last| now_ns - last < PERIOD_NS) {
            self.held_back += 1;
            return None;
        }
        self.last_ns = Some(now_ns);
        Some(std::mem::take(&mut self.held_back))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_at_once_then_one_a_second_with_the_rest_counted() {
        let mut error_limit = ErrorLimit::default();
        let seconds = [0.0, 0.1, 0.9, 1.0, 1.5, 3.0];
        let noted = seconds.map(|s| error_limit.note((s * 1e9) as i64));
        assert_eq!(noted, [Some(0), None, None, Some(2), None, Some(1)]);
    }
}
