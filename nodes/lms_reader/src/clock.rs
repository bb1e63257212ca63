//! Converts a device's clock to host time.
//!
//! Pure: takes device counts and times of reception, returns host times. The device counts
//! microseconds in 32 bits, at its own rate, since it was switched on. Telegrams are late by an
//! unknown delay, never early: the line below all arrivals of the last half minute is the device's
//! clock, and the arrivals on it had the least delay. A constant part of the delay cannot be
//! distinguished from the clock's offset and remains.

use std::collections::VecDeque;

/// Length of a slot of device time, µs; of each slot only the arrival with the least delay is kept.
const SLOT_US: i64 = 1_000_000;
const SLOTS: usize = 32;
/// Largest relative difference between the rates of two clocks: twice 1e-4, for quartz.
const MAX_SKEW: f64 = 2e-4;
/// Largest disagreement of the two clocks from one telegram to the next, µs, longer than any delay;
/// above it the device is assumed to have restarted.
const LONGEST_DELAY_US: i64 = 1_000_000;

/// Arrival of a telegram: the device's count, and the host's time minus that count.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Arrival {
    device_us: i64,
    offset_us: f64,
}

#[derive(Debug, Default)]
pub(crate) struct DeviceClock {
    /// Newest device count, the same without wraps, and its time of reception.
    newest: Option<(u32, i64, i64)>,
    /// Arrival with the least delay of each slot.
    least: VecDeque<Arrival>,
    /// Lower convex hull of `least`; the buffer is reused.
    hull: Vec<Arrival>,
}

impl DeviceClock {
    /// Returns the host time, in nanoseconds, at which the device's clock stood at `device_us`;
    /// never later than the reception at `received_ns`.
    pub(crate) fn host_ns(&mut self, device_us: u32, received_ns: i64) -> i64 {
        let unrolled_us = self.unroll(device_us, received_ns);
        let arrival = Arrival {
            device_us: unrolled_us,
            offset_us: received_ns as f64 * 1e-3 - unrolled_us as f64,
        };
        self.keep(arrival);
        let offset_us = self.line_at(unrolled_us).min(arrival.offset_us);
        // Computed from `received_ns`, so that the result does not lose precision in `f64`.
        let delay_us = (arrival.offset_us - offset_us).max(0.0);
        received_ns - (delay_us * 1e3) as i64
    }

    /// Extends the count beyond 32 bits; starts over if the device has restarted.
    fn unroll(&mut self, device_us: u32, received_ns: i64) -> i64 {
        let unrolled_us = match self.newest {
            Some((last, last_us, last_ns)) => {
                let passed_us = i64::from(device_us.wrapping_sub(last));
                let host_us = received_ns.saturating_sub(last_ns) / 1000;
                if (passed_us - host_us).abs() > LONGEST_DELAY_US + host_us / 1000 {
                    tracing::debug!(device_us, "the device's clock was set back");
                    self.least.clear();
                }
                last_us + passed_us
            }
            None => i64::from(device_us),
        };
        self.newest = Some((device_us, unrolled_us, received_ns));
        unrolled_us
    }

    fn keep(&mut self, arrival: Arrival) {
        let slot = |arrival: &Arrival| arrival.device_us.div_euclid(SLOT_US);
        match self.least.back_mut() {
            Some(newest) if slot(newest) == slot(&arrival) => {
                if arrival.offset_us < newest.offset_us {
                    *newest = arrival;
                }
            }
            _ => self.least.push_back(arrival),
        }
        let oldest = slot(&arrival) - SLOTS as i64;
        self.least.retain(|arrival| slot(arrival) > oldest);
    }

    /// Returns the offset at `device_us` on the closest line below all arrivals: the edge of their
    /// lower hull that spans their middle (Moon, Skelly and Towsley, "Estimation and removal of
    /// clock skew from network delay measurements", 1999; the hull solves their linear program).
    fn line_at(&mut self, device_us: i64) -> f64 {
        self.build_hull();
        let count = self.least.len().max(1) as f64;
        let origin = self.least.front().map_or(0, |arrival| arrival.device_us);
        let since = |us: i64| (us - origin) as f64;
        let middle = self.least.iter().map(|a| since(a.device_us)).sum::<f64>() / count;
        let edge = self.hull.windows(2).find(|edge| {
            edge.last()
                .is_some_and(|end| since(end.device_us) >= middle)
        });
        match (edge, self.hull.first()) {
            (Some(&[from, to]), _) => {
                let skew = slope(from, to).clamp(-MAX_SKEW, MAX_SKEW);
                from.offset_us + skew * (device_us - from.device_us) as f64
            }
            (_, Some(only)) => only.offset_us,
            (_, None) => f64::INFINITY,
        }
    }

    fn build_hull(&mut self) {
        self.hull.clear();
        for &arrival in &self.least {
            while let [.., before, last] = self.hull[..]
                && slope(before, last) >= slope(last, arrival)
            {
                self.hull.pop();
            }
            self.hull.push(arrival);
        }
    }
}

fn slope(from: Arrival, to: Arrival) -> f64 {
    (to.offset_us - from.offset_us) / (to.device_us - from.device_us).max(1) as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    const US: i64 = 1000;

    /// Device switched on at host time `on_ns` whose clock is fast by `ppm`. It sends a telegram
    /// every 20 ms, with a delay of 300 µs and up to `jitter_us` more.
    struct World {
        on_ns: i64,
        first_us: u32,
        ppm: f64,
        jitter_us: u64,
        random: u64,
    }

    impl World {
        fn new(ppm: f64, jitter_us: u64) -> Self {
            World {
                on_ns: 5_000_000_000_000,
                first_us: 0,
                ppm,
                jitter_us,
                random: 9,
            }
        }

        /// Returns the device count of telegram `index`, its true time and its time of reception.
        fn telegram(&mut self, index: i64) -> (u32, i64, i64) {
            let true_ns = self.on_ns + index * 20_000 * US;
            let counted = (index * 20_000) as f64 * (1.0 + self.ppm * 1e-6);
            // Long delays are rarer than short ones.
            self.random = self.random.wrapping_mul(6_364_136_223_846_793_005) + 1;
            let share = (self.random >> 33) as f64 / f64::from(1u32 << 31);
            let delay_us = 300 + (share.powi(3) * self.jitter_us as f64) as i64;
            let device_us = self.first_us.wrapping_add(counted as u32);
            (device_us, true_ns, true_ns + delay_us * US)
        }

        /// Returns the largest error of telegrams `from..to`, µs, not counting the constant delay
        /// of 300 µs, which cannot be known.
        fn error_us(&mut self, clock: &mut DeviceClock, from: i64, to: i64) -> i64 {
            let telegrams = (from..to).map(|index| {
                let (device_us, true_ns, received_ns) = self.telegram(index);
                let found_ns = clock.host_ns(device_us, received_ns);
                assert!(found_ns <= received_ns, "nothing is sent after it came");
                ((found_ns - true_ns) / US - 300).abs()
            });
            telegrams.max().unwrap_or(0)
        }
    }

    #[test]
    fn the_first_telegram_is_taken_as_it_comes() {
        let mut clock = DeviceClock::default();
        assert_eq!(clock.host_ns(77, 1_000_000), 1_000_000);
    }

    #[test]
    fn jitter_is_taken_out() {
        let (mut world, mut clock) = (World::new(0.0, 5000), DeviceClock::default());
        world.error_us(&mut clock, 0, 500);
        // The smallest cube of a thousand uniform draws is a few µs above the least delay.
        let error_us = world.error_us(&mut clock, 500, 3000);
        assert!(error_us < 50, "{error_us} µs of 5000 are left");
    }

    #[test]
    fn a_clock_that_is_fast_or_slow_is_followed() {
        for ppm in [-100.0, 100.0] {
            let (mut world, mut clock) = (World::new(ppm, 5000), DeviceClock::default());
            world.error_us(&mut clock, 0, 1000);
            // In these ten minutes the clocks drift apart by 60 ms.
            let error_us = world.error_us(&mut clock, 1000, 31_000);
            assert!(error_us < 100, "{ppm} ppm: {error_us} µs");
        }
    }

    #[test]
    fn the_wrap_of_the_counter_is_no_event() {
        let (mut world, mut clock) = (World::new(50.0, 2000), DeviceClock::default());
        // It wraps after 24 s.
        world.first_us = u32::MAX - 24_000_000;
        world.error_us(&mut clock, 0, 1000);
        let error_us = world.error_us(&mut clock, 1000, 2000);
        assert!(error_us < 100, "{error_us} µs");
    }

    #[test]
    fn a_device_that_starts_again_is_not_held_to_its_past() {
        let (mut world, mut clock) = (World::new(0.0, 0), DeviceClock::default());
        assert!(world.error_us(&mut clock, 0, 500) < 2);
        world.on_ns += 60_000_000 * US;
        assert!(world.error_us(&mut clock, 0, 500) < 2);
        // The same for a host that was suspended.
        world.on_ns += 7_000_000 * US;
        assert!(world.error_us(&mut clock, 500, 1000) < 2);
    }
}
