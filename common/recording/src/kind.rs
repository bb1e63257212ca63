//! The kinds of message that are decoded.

use std::fmt;

use ros::{LaserScan, OccupancyGridMsg, Odometry, PoseStamped, RosMessage, TfMessage};

pub const SCAN: &str = "/scan";
pub const MAP: &str = "/map";
pub const ODOM: &str = "/odom";
/// Topic of the true poses of the scans: always this name, because any other pose has the same
/// type.
pub const GROUND_TRUTH: &str = "/ground_truth";
/// Topic of the transforms that never change.
pub const TF_STATIC: &str = "/tf_static";

/// A kind of message, by its schema.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Kind {
    Scan,
    Map,
    Odometry,
    PoseStamped,
    /// `tf2_msgs/msg/TFMessage` on a topic that ends in `/tf_static`; messages on `/tf` have the
    /// same schema, but hold only for a moment.
    StaticTransforms,
}

impl Kind {
    pub const ALL: [Kind; 5] = [
        Kind::Scan,
        Kind::Map,
        Kind::Odometry,
        Kind::PoseStamped,
        Kind::StaticTransforms,
    ];

    pub fn schema(self) -> &'static str {
        self.facts()[0]
    }

    pub(crate) fn definition(self) -> &'static str {
        self.facts()[1]
    }

    pub(crate) fn topic(self) -> &'static str {
        self.facts()[2]
    }

    /// Command-line option that selects a channel.
    pub(crate) fn option(self) -> &'static str {
        self.facts()[3]
    }

    /// Name and text of the schema, conventional topic, and the option that selects a channel.
    fn facts(self) -> [&'static str; 4] {
        fn of<M: RosMessage>(topic: &'static str, option: &'static str) -> [&'static str; 4] {
            [M::SCHEMA, M::DEFINITION, topic, option]
        }
        match self {
            Kind::Scan => of::<LaserScan>(SCAN, "--scan-topic"),
            Kind::Map => of::<OccupancyGridMsg>(MAP, "--map-topic"),
            Kind::Odometry => of::<Odometry>(ODOM, "--odom-topic"),
            Kind::PoseStamped => of::<PoseStamped>(GROUND_TRUTH, "--remap"),
            Kind::StaticTransforms => of::<TfMessage>(TF_STATIC, "--remap"),
        }
    }

    /// Returns the kind of a channel. The schema may also have its ROS 1 name, without `msg`, so
    /// that such a channel can be rejected with a reason.
    pub(crate) fn of(schema: &str, topic: &str) -> Option<Kind> {
        let is_named = |kind: &Kind| {
            let name = kind.schema();
            schema == name || schema == name.replace("/msg/", "/")
        };
        let kind = Kind::ALL.into_iter().find(is_named)?;
        let is_static = topic.ends_with(TF_STATIC);
        (kind != Kind::StaticTransforms || is_static).then_some(kind)
    }
}

impl fmt::Display for Kind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.schema())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn schemas_and_topics_decide() {
        assert_eq!(
            Kind::of("sensor_msgs/msg/LaserScan", "/a"),
            Some(Kind::Scan)
        );
        assert_eq!(Kind::of("sensor_msgs/LaserScan", "/a"), Some(Kind::Scan));
        assert_eq!(Kind::of("sensor_msgs/msg/Image", "/scan"), None);
        let transforms = "tf2_msgs/msg/TFMessage";
        assert_eq!(Kind::of(transforms, "/tf"), None);
        for topic in ["/tf_static", "/robot1/tf_static"] {
            assert_eq!(Kind::of(transforms, topic), Some(Kind::StaticTransforms));
        }
    }
}
