//! Errors that end the gateway, and reasons to reject a message.

use ros::ConversionError;
use transport::TransportError;
use zenoh_session::{KeyError, NetworkError};

/// Error of the gateway: says what was tried, what was found and what is allowed.
#[derive(Debug, thiserror::Error)]
pub enum GatewayError {
    /// An option cannot be used.
    #[error("--{option}: {reason}")]
    Option {
        option: &'static str,
        reason: String,
    },
    /// A parameter file cannot be used.
    #[error("{file}: {reason}")]
    ParameterFile {
        /// Path of the file.
        file: String,
        reason: String,
    },
    /// A parameter's value cannot be used.
    #[error("parameter {name} is {found}: allowed are {allowed}")]
    Parameter {
        name: String,
        /// Value found.
        found: String,
        /// Values allowed.
        allowed: String,
    },
    /// The file of the last pose cannot be used.
    #[error("the saved pose in {file} cannot be used: {reason}")]
    SavedPose {
        /// Path of the file.
        file: String,
        reason: String,
    },
    /// An initial pose is in another frame than the map's.
    #[error("the initial pose is in frame {found:?}: allowed is {allowed:?}")]
    InitialPoseFrame {
        found: String,
        /// Frame of the map.
        allowed: String,
    },
    /// The covariance of an initial pose is invalid.
    #[error(
        "the covariance of the initial pose is none: allowed are finite, symmetric and positive \
         ones, and zeros where nobody knows"
    )]
    InitialPoseCovariance,
    /// A line of a message definition is not a field.
    #[error("the definition of {name}: {line:?} is not a field")]
    Definition {
        /// Name of the type.
        name: String,
        line: String,
    },
    /// The graph cannot hold a map.
    #[error(transparent)]
    Map(#[from] map::MapError),
    /// The session cannot be opened.
    #[error(transparent)]
    Network(#[from] NetworkError),
    /// A key of Zenoh cannot be used.
    #[error(transparent)]
    Key(#[from] KeyError),
    /// DDS cannot be used.
    #[error("cannot {action} the domain of DDS: {reason}")]
    Dds {
        /// Action that failed.
        action: &'static str,
        reason: String,
    },
    /// A message cannot be sent.
    #[error("the message for {topic} cannot be sent: {reason}")]
    Send {
        /// The robot's topic or service.
        topic: String,
        reason: String,
    },
    /// A message is longer than allowed.
    #[error("the message of {topic} has {found} bytes: allowed are at most {most}")]
    TooLong {
        topic: String,
        /// Size of the message, bytes.
        found: usize,
        /// Largest size allowed, bytes.
        most: usize,
    },
    /// The attachment of a message is not that of `rmw_zenoh`.
    #[error(
        "the attachment of {topic} has {found} bytes: allowed are the 33 of rmw_zenoh (sequence \
         number, time, sender)"
    )]
    Attachment {
        /// The robot's topic or service.
        topic: String,
        /// Size of the attachment, bytes.
        found: usize,
    },
    /// A message is not in CDR, or not of its type.
    #[error("the message of {topic} cannot be read: {reason}")]
    Message {
        /// The robot's topic.
        topic: String,
        reason: String,
    },
    /// A message cannot be written in CDR.
    #[error("the message for {topic} cannot be written: {reason}")]
    Encode {
        /// The robot's topic.
        topic: String,
        reason: String,
    },
    /// Another node has this one's name.
    #[error(
        "there is a second node {0}: both answer its services and publish its transform; leave the \
         other one out of the launch file, or give this one another --node"
    )]
    SecondNode(String),
    /// Standard output cannot be written.
    #[error(transparent)]
    Output(#[from] command_line::OutputError),
    /// Another node publishes the transform that the gateway publishes.
    #[error(
        "another node publishes the transform from {parent} to {child} on {topic}, as this one does, \
         and poses jump between the two: stop the other one, as AMCL or a SLAM"
    )]
    SecondBroadcaster {
        /// Parent frame of the other node's transform.
        parent: String,
        /// Frame of the odometry.
        child: String,
        topic: String,
    },
    /// A number is not finite.
    #[error("{field} of {topic} is {found}: allowed is a finite number")]
    Number {
        topic: String,
        field: &'static str,
        found: f64,
    },
    /// A stamp is before 1970, or has a second or more in its nanoseconds.
    #[error(
        "the stamp of {topic} is {sec} s and {nanosec} ns: allowed are times from 1970 on, with \
         less than 1000000000 ns"
    )]
    Stamp {
        topic: String,
        /// Seconds since 1970.
        sec: i32,
        /// Nanoseconds within the second.
        nanosec: u32,
    },
    /// A time is outside the range of ROS stamps.
    #[error("a stamp of {stamp_ns} ns: allowed are 0 to 2147483647999999999, the times of ROS")]
    Unstampable {
        /// Nanoseconds since 1970.
        stamp_ns: i64,
    },
    /// A pose, a transform or a map is invalid, or the graph cannot represent it.
    #[error(transparent)]
    Conversion(#[from] ConversionError),
    /// A topic that the gateway takes is published as another type.
    #[error("{node} publishes {topic} as {found}, which is not supported: expected is {expected}")]
    Stranger {
        node: String,
        topic: String,
        /// Type and hash found.
        found: String,
        /// Type and hash expected.
        expected: String,
    },
    /// A transform of `/tf_static` is invalid; the others of its message are used.
    #[error("the transform from {parent} to {child} is ignored")]
    Transform {
        parent: String,
        child: String,
        source: ConversionError,
    },
    /// A laser is neither level nor upside down.
    #[error(
        "the laser {laser} is tilted by {tilt_degrees:.1} degrees against {base}: allowed are at \
         most {}, also upside down",
        recording::MAX_TILT_DEGREES
    )]
    Tilted {
        /// Frame of the laser.
        laser: String,
        /// Frame of the base.
        base: String,
        /// Angle between their z axes, degrees.
        tilt_degrees: f64,
    },
    /// A lidar whose height and tilt are not known.
    #[error(
        "no transform says where {frame}, the frame of the point cloud, sits on the robot: allowed \
         are clouds with a mount, by /tf_static or --cloud-mount"
    )]
    NoCloudMount {
        /// Frame of the point clouds.
        frame: String,
    },
    /// The name of a frame is too long.
    #[error("a frame's name has {found} bytes: allowed are at most {most}")]
    FrameName {
        /// Length of the name, bytes.
        found: usize,
        /// Largest length allowed, bytes.
        most: usize,
    },
    /// There are more frames than allowed.
    #[error("too many frames, {frame:?} is ignored: allowed are {most}")]
    Frames {
        /// Frame that is ignored.
        frame: String,
        /// Largest number of frames.
        most: usize,
    },
    /// The graph fails.
    #[error(transparent)]
    Transport(#[from] TransportError),
}

impl GatewayError {
    /// Returns a function that converts an error of writing a message for `topic`.
    pub(crate) fn encoding<E: std::fmt::Display>(topic: &str) -> impl FnOnce(E) -> Self {
        move |error| GatewayError::Encode {
            topic: topic.to_owned(),
            reason: error.to_string(),
        }
    }
}
