//! Times of the graph as ROS has them.

use messages::Stamp;
use ros::{Header, Time};

use crate::GatewayError;

/// The header of a message about a scan, in the frame of the map.
///
/// # Errors
/// [`GatewayError::Unstampable`].
pub(crate) fn in_map(of: Stamp, map_frame: &str) -> Result<Header, GatewayError> {
    Ok(Header::new(stamp(of.measured_ns)?, map_frame))
}

/// Nanoseconds since 1970 as ROS has them.
///
/// # Errors
/// [`GatewayError::Unstampable`] for times that are negative or too large for its 32 bits.
pub(crate) fn stamp(stamp_ns: i64) -> Result<Time, GatewayError> {
    let stamp = Time::from_ns(stamp_ns).filter(|_| stamp_ns >= 0);
    stamp.ok_or(GatewayError::Unstampable { stamp_ns })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_that_ros_cannot_say_are_refused() {
        assert_eq!(stamp(5).unwrap().nanosec, 5);
        assert!(stamp(-1).is_err() && stamp(i64::MAX).is_err());
    }
}
