//! From the messages of ROS to those of the graph.
//!
//! Stamps lack what only the moment of sending gives: when they enter the graph
//! and their counter. Readings are not looked at.

use messages::{GroundTruth, Name, Odometry, Pose2, ScanHeader, Stamp};
use recording::ros::{self, LaserScan, PoseStamped, Time};

use crate::PlaybackError;

/// Where a message stands, for errors.
pub(crate) struct Place<'a> {
    pub(crate) topic: &'a str,
    pub(crate) log_time_ns: i64,
}

impl Place<'_> {
    pub(crate) fn name(&self, frame: &str) -> Result<Name, PlaybackError> {
        if frame.len() <= Name::CAPACITY {
            return Ok(Name::new(frame));
        }
        Err(PlaybackError::Frame {
            topic: self.topic.into(),
            log_time_ns: self.log_time_ns,
            frame: frame.into(),
        })
    }

    fn pose(&self, pose: &ros::Pose) -> Result<Pose2, PlaybackError> {
        match pose.planar() {
            Ok(pose) => Ok(pose.into()),
            Err(reason) => Err(PlaybackError::Pose {
                topic: self.topic.into(),
                log_time_ns: self.log_time_ns,
                reason: Box::new(reason),
            }),
        }
    }

    pub(crate) fn odometry(&self, message: &ros::Odometry) -> Result<Odometry, PlaybackError> {
        Ok(Odometry {
            stamp: measured(message.header.stamp),
            odom_from_child: self.pose(&message.pose.pose)?,
            twist: message.twist.twist.planar().into(),
            covariance: message.pose.planar_covariance(),
            frame: self.name(&message.header.frame_id)?,
            child_frame: self.name(&message.child_frame_id)?,
        })
    }

    pub(crate) fn ground_truth(&self, message: &PoseStamped) -> Result<GroundTruth, PlaybackError> {
        Ok(GroundTruth {
            stamp: measured(message.header.stamp),
            map_from_laser: self.pose(&message.pose)?,
            frame: self.name(&message.header.frame_id)?,
        })
    }
}

pub(crate) fn scan_header(scan: &LaserScan, frame: Name, mount: Option<Pose2>) -> ScanHeader {
    ScanHeader {
        stamp: measured(scan.header.stamp),
        angle_min: scan.angle_min.into(),
        angle_increment: scan.angle_increment.into(),
        time_increment_s: scan.time_increment.into(),
        scan_time_s: scan.scan_time.into(),
        range_min_m: scan.range_min,
        range_max_m: scan.range_max,
        base_from_laser: mount.unwrap_or(Pose2 {
            x: 0.0,
            y: 0.0,
            yaw: 0.0,
        }),
        mount_known: u64::from(mount.is_some()),
        frame,
    }
}

fn measured(time: Time) -> Stamp {
    Stamp {
        measured_ns: time.as_ns(),
        ..Stamp::default()
    }
}
