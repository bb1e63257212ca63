//! Conversion of the graph's stamps to those of ROS.

use messages::Stamp;
use ros::{Header, Time};

use crate::GatewayError;

/// The header of a message about a scan, in the frame of the map.
pub(crate) fn in_map(of: Stamp, map_frame: &str) -> Result<Header, GatewayError> {
    Ok(Header::new(stamp(of.measured_ns)?, map_frame))
}

/// Converts nanoseconds since 1970 to a time of ROS.
pub(crate) fn stamp(stamp_ns: i64) -> Result<Time, GatewayError> {
    let stamp = Time::from_ns(stamp_ns).filter(|_| stamp_ns >= 0);
    stamp.ok_or_else(|| {
        GatewayError::Refused(format!(
            "a stamp of {stamp_ns} ns: allowed are 0 to 2147483647999999999, the times of ROS"
        ))
    })
}

/// A step back by more than this is from a clock that was set, or a simulation or recording that
/// restarted, nanoseconds.
const SET_BACK_NS: i64 = 2_000_000_000;

/// Rejects times that are not later than the last one: transform buffers treat an older one as an
/// error.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Forward {
    last_ns: Option<i64>,
}

impl Forward {
    /// True if the time, nanoseconds, is later than the last one, or the clock was set back; keeps
    /// it as the last one then.
    pub(crate) fn admits(&mut self, at_ns: i64) -> bool {
        let is_later = self.is_later(at_ns);
        if is_later {
            self.note(at_ns);
        }
        is_later
    }

    /// True if the time, nanoseconds, is later than the last one, or the clock was set back.
    pub(crate) fn is_later(&self, at_ns: i64) -> bool {
        let is_behind = |last_ns: i64| (0..=SET_BACK_NS).contains(&last_ns.saturating_sub(at_ns));
        !self.last_ns.is_some_and(is_behind)
    }

    pub(crate) fn note(&mut self, at_ns: i64) {
        self.last_ns = Some(at_ns);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_go_forward_unless_the_clock_was_set_back() {
        let mut forward = Forward::default();
        let ms = 1_000_000;
        let times = [5000, 5050, 5040, 5050, 5051, 100, 150, 120].map(|time| time * ms);
        let admitted = times.map(|at_ns| forward.admits(at_ns));
        assert_eq!(
            admitted,
            [true, true, false, false, true, true, true, false]
        );
    }

    #[test]
    fn times_that_ros_cannot_say_are_refused() {
        assert_eq!(stamp(5).unwrap().nanosec, 5);
        assert!(stamp(-1).is_err() && stamp(i64::MAX).is_err());
    }
}
