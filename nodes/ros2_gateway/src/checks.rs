//! Checks of the robot's messages.

use messages::Odometry as GraphOdometry;
use ros::{LaserScan, Odometry, Time, TransformStamped};

use crate::GatewayError;

/// Rejects a scan with a number that is not finite or an invalid stamp.
pub(crate) fn check_scan(message: &LaserScan) -> Result<(), GatewayError> {
    measured_ns("the scan", message.header.stamp)?;
    let numbers = [
        ("angle_min", message.angle_min),
        ("angle_increment", message.angle_increment),
        ("time_increment", message.time_increment),
        ("scan_time", message.scan_time),
    ];
    for (field, found) in numbers {
        finite("the scan", field, found.into())?;
    }
    Ok(())
}

/// Converts odometry to the graph's message; rejects numbers that are not finite and invalid
/// stamps.
pub(crate) fn sound_odometry(message: &Odometry) -> Result<GraphOdometry, GatewayError> {
    measured_ns("the odometry", message.header.stamp)?;
    let odometry = ros::measurements::odometry(message)?;
    let twist = odometry.twist;
    for (field, found) in [("twist", twist.x), ("twist", twist.y), ("twist", twist.yaw)] {
        finite("the odometry", field, found)?;
    }
    for found in odometry.covariance {
        finite("the odometry", "covariance", found)?;
    }
    Ok(odometry)
}

/// Makes odometry from a transform of /tf: a pose without a twist.
pub(crate) fn odometry_of(transform: TransformStamped) -> Result<GraphOdometry, GatewayError> {
    let mut message = Odometry {
        header: transform.header,
        child_frame_id: transform.child_frame_id,
        ..Odometry::default()
    };
    let place = transform.transform.translation;
    message.pose.pose.position.x = place.x;
    message.pose.pose.position.y = place.y;
    message.pose.pose.orientation = transform.transform.rotation;
    sound_odometry(&message)
}

/// Converts a stamp to nanoseconds; rejects times before 1970 and a second or more of nanoseconds.
pub(crate) fn measured_ns(topic: &str, stamp: Time) -> Result<i64, GatewayError> {
    let Time { sec, nanosec } = stamp;
    if sec >= 0 && nanosec < 1_000_000_000 {
        return Ok(stamp.as_ns());
    }
    Err(GatewayError::Refused(format!(
        "the stamp of {topic} is {sec} s and {nanosec} ns: allowed are times from 1970 on, with \
         less than 1000000000 ns"
    )))
}

fn finite(topic: &str, field: &'static str, found: f64) -> Result<(), GatewayError> {
    if found.is_finite() {
        return Ok(());
    }
    Err(GatewayError::Refused(format!(
        "{field} of {topic} is {found}: allowed is a finite number"
    )))
}

#[cfg(test)]
mod tests {
    use messages::FrameName;

    use super::*;

    #[test]
    fn transforms_say_what_odometry_says() {
        let mut transform = TransformStamped::default();
        transform.header.stamp = Time { sec: 3, nanosec: 4 };
        transform.header.frame_id = "odom".to_owned();
        transform.child_frame_id = "base_link".to_owned();
        transform.transform.translation.x = 1.5;
        let odometry = odometry_of(transform.clone()).unwrap();
        assert_eq!(odometry.stamp.measured_ns, 3_000_000_004);
        assert_eq!(
            (odometry.odom_from_child.x, odometry.child_frame),
            (1.5, FrameName::new("base_link"))
        );
        transform.transform.rotation.w = 7.0;
        assert!(odometry_of(transform).is_err());
    }

    #[test]
    fn a_laser_may_turn_clockwise() {
        let scan = LaserScan {
            angle_min: 1.5,
            angle_increment: -0.01,
            ..LaserScan::default()
        };
        check_scan(&scan).unwrap();
    }

    #[test]
    fn numbers_and_times_that_are_none_are_refused() {
        let refuse = |spoil: fn(&mut LaserScan), expected: &str| {
            let mut scan = LaserScan::default();
            check_scan(&scan).unwrap();
            spoil(&mut scan);
            let error = check_scan(&scan).unwrap_err().to_string();
            assert!(error.contains(expected), "{error}");
        };
        refuse(
            |scan| scan.angle_min = f32::NAN,
            "angle_min of the scan is NaN",
        );
        refuse(|scan| scan.scan_time = f32::INFINITY, "scan_time");
        refuse(|scan| scan.header.stamp.sec = -1, "-1 s");
        refuse(|scan| scan.header.stamp.nanosec = u32::MAX, "4294967295 ns");
        let mut odometry = Odometry::default();
        odometry.pose.covariance[5][5] = f64::NAN;
        assert!(sound_odometry(&odometry).is_err());
        odometry = Odometry::default();
        odometry.twist.twist.angular.z = f64::INFINITY;
        assert!(sound_odometry(&odometry).is_err());
    }
}
