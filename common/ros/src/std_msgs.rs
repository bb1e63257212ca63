//! `std_msgs/msg/Header`, `std_msgs/msg/String` and `builtin_interfaces/msg/Time`.

use serde::{Deserialize, Serialize};

use super::RosMessage;

/// Time and frame of a measurement.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Header {
    pub stamp: Time,
    pub frame_id: String,
}

impl Header {
    #[must_use]
    pub fn new(stamp: Time, frame: &str) -> Self {
        Header {
            stamp,
            frame_id: frame.to_owned(),
        }
    }
}

/// `std_msgs/msg/String`.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct Text {
    pub data: String,
}

impl RosMessage for Text {
    const SCHEMA: &'static str = "std_msgs/msg/String";
    const DEFINITION: &'static str = "string data\n";
}

/// Time since 1970.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct Time {
    pub sec: i32,
    /// Nanoseconds within the second.
    pub nanosec: u32,
}

impl Time {
    /// Nanoseconds since 1970; seconds of 32 bits always fit.
    #[must_use]
    pub fn as_ns(self) -> i64 {
        i64::from(self.sec) * 1_000_000_000 + i64::from(self.nanosec)
    }

    /// Converts nanoseconds since 1970; `None` if the seconds do not fit 32 bits.
    #[must_use]
    pub fn from_ns(ns: i64) -> Option<Self> {
        Some(Time {
            sec: i32::try_from(ns.div_euclid(1_000_000_000)).ok()?,
            // A remainder below 10⁹ fits.
            nanosec: ns.rem_euclid(1_000_000_000) as u32,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_become_nanoseconds_and_back() {
        for ns in [0, 1_137_772_793_094_853_000, -1] {
            assert_eq!(Time::from_ns(ns).unwrap().as_ns(), ns);
        }
        assert_eq!(Time::from_ns(i64::MAX), None);
        let last = Time {
            sec: i32::MIN,
            nanosec: u32::MAX,
        };
        assert_eq!(last.as_ns(), -2_147_483_643_705_032_705);
    }
}
