//! Converts scans, odometry and true poses of ROS to messages of the graph.
//!
//! Their stamps still lack the fields that are set on sending: the time of entering the graph, and
//! the counter. Ranges are not converted here.

use geometry::Mount;
use messages::{FrameName, GroundTruth, Name, Odometry, ScanHeader, Stamp};

use crate as ros;
use crate::ConversionError;
use crate::{LaserScan, PoseStamped, Time};

/// Converts the name of a frame.
pub fn frame(frame: &str) -> Result<FrameName, ConversionError> {
    if frame.len() <= FrameName::CAPACITY {
        return Ok(FrameName::new(frame));
    }
    Err(ConversionError(format!(
        "the frame {frame:?} has {} bytes, at most {} are allowed",
        frame.len(),
        FrameName::CAPACITY
    )))
}

/// Converts the header of a scan of the graph's only laser; `mount` is the mount of the laser on
/// the base, if known.
pub fn scan_header(scan: &LaserScan, frame: FrameName, mount: Option<Mount>) -> ScanHeader {
    let known = mount.unwrap_or_default();
    ScanHeader {
        stamp: measured(scan.header.stamp),
        angle_min: scan.angle_min.into(),
        angle_increment: scan.angle_increment.into(),
        time_increment_s: scan.time_increment.into(),
        scan_time_s: scan.scan_time.into(),
        range_min_m: scan.range_min,
        range_max_m: scan.range_max,
        base_from_laser: known.base_from_laser.into(),
        mount_known: mount.is_some().into(),
        upside_down: known.is_upside_down.into(),
        laser: Name::new(""),
        frame,
    }
}

/// Converts odometry.
pub fn odometry(message: &ros::Odometry) -> Result<Odometry, ConversionError> {
    Ok(Odometry {
        stamp: measured(message.header.stamp),
        odom_from_child: message.pose.pose.planar()?.into(),
        twist: message.twist.twist.planar().into(),
        covariance: message.pose.planar_covariance(),
        frame: frame(&message.header.frame_id)?,
        child_frame: frame(&message.child_frame_id)?,
    })
}

/// Converts the true pose of a laser.
pub fn ground_truth(message: &PoseStamped) -> Result<GroundTruth, ConversionError> {
    Ok(GroundTruth {
        stamp: measured(message.header.stamp),
        map_from_laser: message.pose.planar()?.into(),
        frame: frame(&message.header.frame_id)?,
    })
}

fn measured(time: Time) -> Stamp {
    Stamp::measured_at(time.as_ns())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_the_graph_cannot_say_is_refused() {
        let mut message = ros::Odometry::default();
        assert!(odometry(&message).is_ok());
        message.child_frame_id = "f".repeat(257);
        let error = odometry(&message).unwrap_err().to_string();
        assert!(
            error.ends_with("has 257 bytes, at most 256 are allowed"),
            "{error}"
        );
        let mut turned = PoseStamped::default();
        turned.pose.orientation.w = f64::NAN;
        let error = ground_truth(&turned).unwrap_err().to_string();
        assert!(error.contains("not a rotation"), "{error}");
    }
}
