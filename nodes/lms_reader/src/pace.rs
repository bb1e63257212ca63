//! Playback times of the telegrams of a capture, by the device's own clock.
//!
//! Pure: takes device times, returns times since the first telegram. The sum of differences does
//! not drift, and the wrap of the clock does not matter.

use std::time::Duration;

/// Longest gap accepted, µs. After a longer one the device or the capture was restarted, and the
/// previous step is used.
const LONGEST_GAP_US: u32 = 10_000_000;

#[derive(Debug, Default)]
pub(crate) struct Pace {
    last_us: Option<u32>,
    step_us: u32,
    elapsed_us: u64,
}

impl Pace {
    /// Returns the time after the first telegram at which this one is due.
    pub(crate) fn due(&mut self, time_of_transmission_us: u32) -> Duration {
        if let Some(last_us) = self.last_us.replace(time_of_transmission_us) {
            let gap_us = time_of_transmission_us.wrapping_sub(last_us);
            if gap_us <= LONGEST_GAP_US {
                self.step_us = gap_us;
            }
            self.elapsed_us += u64::from(self.step_us);
        }
        Duration::from_micros(self.elapsed_us)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn follows_the_device_across_its_wrap_and_its_restart() {
        let mut pace = Pace::default();
        let times = [u32::MAX - 999, 65_000, 131_000, 500, 66_500];
        let due = times.map(|time| pace.due(time).as_micros());
        // The restart at 500 µs is bridged by the step before it, 66 ms.
        assert_eq!(due, [0, 66_000, 132_000, 198_000, 264_000]);
    }
}
