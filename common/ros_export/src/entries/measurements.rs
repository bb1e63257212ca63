//! Scans, odometry and true poses as ROS says them.

use messages::{GroundTruth, Odometry, ScanHeader};
use ros::{Header, LaserScan, PoseStamped, Time, Twist, TwistWithCovariance, planar};

pub(super) fn scan(stamp: Time, scan: &ScanHeader, ranges: &[f32]) -> LaserScan {
    let steps = ranges.len().saturating_sub(1) as f64;
    LaserScan {
        header: Header {
            stamp,
            frame_id: scan.frame.as_str().to_owned(),
        },
        // Recordings hold 32 bits, and a scan that was played came from them.
        angle_min: scan.angle_min as f32,
        angle_max: (scan.angle_min + steps * scan.angle_increment) as f32,
        angle_increment: scan.angle_increment as f32,
        time_increment: scan.time_increment_s as f32,
        scan_time: scan.scan_time_s as f32,
        range_min: scan.range_min_m,
        range_max: scan.range_max_m,
        ranges: ranges.to_vec(),
        intensities: Vec::new(),
    }
}

pub(super) fn odometry(stamp: Time, odometry: &Odometry) -> ros::Odometry {
    ros::Odometry {
        header: Header {
            stamp,
            frame_id: odometry.frame.as_str().to_owned(),
        },
        child_frame_id: odometry.child_frame.as_str().to_owned(),
        pose: planar::estimate(odometry.odom_from_child.into(), odometry.covariance),
        twist: TwistWithCovariance {
            twist: Twist::from_planar(odometry.twist.into()),
            ..TwistWithCovariance::default()
        },
    }
}

pub(super) fn ground_truth(stamp: Time, truth: &GroundTruth) -> PoseStamped {
    PoseStamped {
        header: Header {
            stamp,
            frame_id: truth.frame.as_str().to_owned(),
        },
        pose: planar::pose(truth.map_from_laser.into()),
    }
}

#[cfg(test)]
mod tests {
    use bytemuck::Zeroable;
    use messages::{FrameName, Pose2};

    use super::*;

    #[test]
    fn a_scan_ends_where_its_last_beam_points() {
        let header = ScanHeader {
            angle_min: -1.5,
            angle_increment: 0.5,
            range_max_m: 80.0,
            frame: FrameName::new("laser"),
            ..ScanHeader::zeroed()
        };
        let message = scan(Time::default(), &header, &[1.0, f32::INFINITY, 3.0]);
        assert_eq!((message.angle_min, message.angle_max), (-1.5, -0.5));
        assert_eq!(message.ranges, [1.0, f32::INFINITY, 3.0]);
        assert_eq!(message.header.frame_id, "laser");
        let empty = scan(Time::default(), &header, &[]);
        assert_eq!(empty.angle_max, -1.5);
    }

    #[test]
    fn odometry_comes_back() {
        let pose = Pose2 {
            x: 1.0,
            y: 2.0,
            yaw: 0.5,
        };
        let given = Odometry {
            odom_from_child: pose,
            twist: pose,
            covariance: [0.25; 9],
            frame: FrameName::new("odom"),
            child_frame: FrameName::new("base_link"),
            ..Odometry::zeroed()
        };
        let message = odometry(Time::default(), &given);
        assert_eq!(message.child_frame_id, "base_link");
        assert_eq!(message.pose.planar_covariance(), [0.25; 9]);
        assert_eq!(message.twist.twist.planar(), pose.into());
        let back = message.pose.pose.planar().unwrap();
        // The yaw is rounded to 2⁻⁴⁰ rad.
        assert!(back.is_within(pose.into(), 0.0, 1e-12), "{back:?}");
    }
}
