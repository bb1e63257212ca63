//! CPU time of this thread: the cost of a computation, independent of the load of the machine.

use answers::statistics::Distribution;

/// Runs `work` and returns its result, with the CPU time of this thread in milliseconds.
pub fn cpu_ms<T>(work: impl FnOnce() -> T) -> (T, f64) {
    offline::cpu::timed(work).expect("a thread has a clock")
}

/// Median of the values, the lower of the two middle ones; NaN without values.
pub fn median(values: Vec<f64>) -> f64 {
    let [median] = Distribution::from_iter(values).percentiles([50.0]);
    median.unwrap_or(f64::NAN)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_median_is_one_of_the_values() {
        assert_eq!(median(vec![3.0, 1.0, 2.0]), 2.0);
        assert_eq!(median(vec![4.0, 1.0, 2.0, 3.0]), 2.0);
        assert!(median(vec![]).is_nan());
    }
}
