//! CPU time of this thread: the cost of a computation, independent of the load of the machine.

use std::time::Duration;

use nix::time::{ClockId, clock_gettime};

/// Runs `work` and returns its result, with the CPU time of this thread in milliseconds.
///
/// # Panics
/// The system has no CPU clock for threads, which Linux has.
pub fn cpu_ms<T>(work: impl FnOnce() -> T) -> (T, f64) {
    let start = thread_time();
    let done = work();
    let cost = thread_time().saturating_sub(start);
    (done, cost.as_secs_f64() * 1e3)
}

/// Median of the values, the lower of the two middle ones; NaN without values.
#[must_use]
pub fn median(mut values: Vec<f64>) -> f64 {
    values.sort_unstable_by(f64::total_cmp);
    let middle = values.len().saturating_sub(1) / 2;
    values.get(middle).copied().unwrap_or(f64::NAN)
}

fn thread_time() -> Duration {
    let time = clock_gettime(ClockId::CLOCK_THREAD_CPUTIME_ID);
    Duration::from(time.expect("a thread has a clock"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn computing_costs() {
        let spin = || {
            let start = thread_time();
            while thread_time() - start < Duration::from_millis(2) {}
            "done"
        };
        let (said, cost) = cpu_ms(spin);
        assert_eq!(said, "done");
        assert!(cost >= 2.0, "{cost}");
    }

    #[test]
    fn the_median_is_one_of_the_values() {
        assert_eq!(median(vec![3.0, 1.0, 2.0]), 2.0);
        assert_eq!(median(vec![4.0, 1.0, 2.0, 3.0]), 2.0);
        assert!(median(vec![]).is_nan());
    }
}
