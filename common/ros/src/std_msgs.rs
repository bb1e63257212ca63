//! `std_msgs`, and other types of few fields.

declare! {
    /// Time and frame of a measurement.
    part Header = "std_msgs/Header" [Time] {
        stamp: Time,
        frame_id: String,
    }

    /// Time since 1970.
    #[derive(Copy)]
    part Time = "builtin_interfaces/Time" [] {
        sec: i32,
        /// Nanoseconds within the second.
        nanosec: u32,
    }

    message Text = "std_msgs/msg/String" [] {
        data: String,
    }

    /// `rosgraph_msgs/msg/Clock`: time of a simulation.
    #[derive(Copy)]
    message Clock = "rosgraph_msgs/msg/Clock" [Time] {
        clock: Time,
    }

    /// `bond/msg/Status`: heartbeat by which two nodes monitor each other.
    message BondStatus = "bond/msg/Status" [Header] {
        header: Header,
        /// Id of the bond, the same for both nodes.
        id: String,
        /// Id of the sending node.
        instance_id: String,
        /// False if the bond ends.
        active: bool,
        /// Seconds without a heartbeat after which the bond is broken.
        heartbeat_timeout: f32,
        /// Seconds between heartbeats.
        heartbeat_period: f32,
    }
}

impl Header {
    pub fn new(stamp: Time, frame: &str) -> Self {
        Header {
            stamp,
            frame_id: frame.to_owned(),
        }
    }
}

impl Time {
    /// Nanoseconds since 1970; seconds of 32 bits always fit.
    pub fn as_ns(self) -> i64 {
        i64::from(self.sec) * 1_000_000_000 + i64::from(self.nanosec)
    }

    /// Converts nanoseconds since 1970; `None` if the seconds do not fit 32 bits.
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
