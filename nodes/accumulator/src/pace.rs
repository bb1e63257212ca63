//! Limits the rate of an event. Pure: the time is an argument.

#[derive(Debug, Clone, Copy)]
pub(crate) struct Pace {
    period_ns: i64,
    next_ns: Option<i64>,
}

impl Pace {
    /// Creates a limiter for at most `rate` events per second; the first one passes at once.
    pub(crate) fn new(rate: f64) -> Self {
        Pace {
            period_ns: (1e9 / rate) as i64,
            next_ns: None,
        }
    }

    /// Returns true if an event may happen now, and counts it as happened.
    pub(crate) fn pass(&mut self, now_ns: i64) -> bool {
        if self.next_ns.is_some_and(|next| now_ns < next) {
            return false;
        }
        self.next_ns = Some(now_ns.saturating_add(self.period_ns));
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_event_a_period_passes_and_the_first_at_once() {
        let mut pace = Pace::new(2.0);
        let passed = [0, 1, 499_999_999, 500_000_000, 900_000_000, 1_000_000_000]
            .map(|now_ns| pace.pass(now_ns));
        assert_eq!(passed, [true, false, false, true, false, true]);
        assert!(Pace::new(0.1).pass(i64::MAX), "no time overflows");
    }
}
