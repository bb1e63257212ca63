//! Snapshots of a drive as ROS 2 messages, with the frames that robots use:
//! `map`, `odom`, `base_link` and `laser`.

use geometry::Pose;
use map::OccupancyGrid;
use recording::Message;
use recording::ros;
use recording::ros::{
    Header, LaserScan, OccupancyGridMsg, Odometry, PoseStamped, Quaternion, TfMessage, Time,
    Transform, TransformStamped, Vector3,
};
use simulation::{Bearings, DriveConfig, Snapshot};

/// What all messages of a recording share.
pub(super) struct Messages {
    bearings: Bearings,
    base_from_laser: Pose,
    range_max_m: f32,
    scan_time_s: f32,
}

impl Messages {
    pub(super) fn new(config: &DriveConfig, bearings: Bearings) -> Self {
        Messages {
            bearings,
            base_from_laser: config.mount.0,
            range_max_m: config.range_max_m() as f32,
            scan_time_s: (1.0 / config.rate) as f32,
        }
    }

    pub(super) fn map(&self, map: &OccupancyGrid, stamp: Time) -> Message {
        let mut message = OccupancyGridMsg::from_grid(map);
        message.header = header(stamp, "map");
        message.info.map_load_time = stamp;
        Message::Map(message)
    }

    pub(super) fn mount(&self, stamp: Time) -> Message {
        let Pose { x, y, yaw } = self.base_from_laser;
        let transforms = vec![TransformStamped {
            header: header(stamp, "base_link"),
            child_frame_id: "laser".into(),
            transform: Transform {
                translation: Vector3 { x, y, z: 0.0 },
                rotation: Quaternion::from_yaw(yaw),
            },
        }];
        Message::StaticTransforms(TfMessage { transforms })
    }

    pub(super) fn odometry(&self, snapshot: &Snapshot, stamp: Time) -> Message {
        let mut message = Odometry {
            header: header(stamp, "odom"),
            child_frame_id: "base_link".into(),
            ..Odometry::default()
        };
        message.pose.pose = ros::Pose::from_planar(snapshot.odom_from_base);
        let Pose { x, y, yaw } = snapshot.twist;
        message.twist.twist.linear = Vector3 { x, y, z: 0.0 };
        message.twist.twist.angular.z = yaw;
        Message::Odometry(Box::new(message))
    }

    pub(super) fn truth(&self, snapshot: &Snapshot, stamp: Time) -> Message {
        Message::PoseStamped(PoseStamped {
            header: header(stamp, "map"),
            pose: ros::Pose::from_planar(snapshot.map_from_laser),
        })
    }

    pub(super) fn scan(&self, snapshot: Snapshot, stamp: Time) -> Message {
        Message::Scan(LaserScan {
            header: header(stamp, "laser"),
            angle_min: self.bearings.angle_min,
            angle_max: self.bearings.angle_max(),
            angle_increment: self.bearings.angle_increment,
            time_increment: 0.0,
            scan_time: self.scan_time_s,
            range_min: 0.0,
            range_max: self.range_max_m,
            ranges: snapshot.ranges,
            intensities: Vec::new(),
        })
    }
}

fn header(stamp: Time, frame: &str) -> Header {
    Header {
        stamp,
        frame_id: frame.into(),
    }
}
