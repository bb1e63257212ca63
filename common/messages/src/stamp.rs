//! Times of a measurement.

crate::message! {
    #[type_name("Stamp/v1")]
    /// Times and number of a measurement. Every step copies the stamp of its input, so latency is
    /// always now minus `entered_ns`.
    #[derive(Eq, Default)]
    pub struct Stamp {
        /// Time of the measurement by the source's clock, in nanoseconds since 1970; a recording
        /// keeps the original time.
        pub measured_ns: i64,
        /// `CLOCK_MONOTONIC` of the host in nanoseconds when it entered the graph.
        pub entered_ns: i64,
        /// Number of the measurement at its publisher, from 0; gaps show losses.
        pub counter: u64,
    }
}

impl Stamp {
    /// Makes a stamp with this time of measurement, in nanoseconds; its other numbers are 0.
    #[must_use]
    pub fn measured_at(measured_ns: i64) -> Self {
        Stamp {
            measured_ns,
            ..Stamp::default()
        }
    }

    /// True if both are of the same measurement. `entered_ns` is ignored, as it differs by machine.
    #[must_use]
    pub fn is_of(self, other: Stamp) -> bool {
        (self.measured_ns, self.counter) == (other.measured_ns, other.counter)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_measurement_is_the_same_on_each_machine() {
        let here = Stamp {
            measured_ns: 5,
            entered_ns: 100,
            counter: 7,
        };
        let there = Stamp {
            entered_ns: 900,
            ..here
        };
        assert!(here.is_of(there));
        assert!(!here.is_of(Stamp { counter: 8, ..here }));
        assert!(!here.is_of(Stamp {
            measured_ns: 6,
            ..here
        }));
    }
}
