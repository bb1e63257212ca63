//! Errors that end the gateway, and reasons to reject a message.

use ros::ConversionError;
use transport::TransportError;
use zenoh_session::{KeyError, NetworkError};

/// Error of the gateway: says what was tried, what was found and what is allowed.
#[derive(Debug, thiserror::Error)]
pub enum GatewayError {
    #[error("--{option}: {reason}")]
    Option {
        option: &'static str,
        reason: String,
    },
    #[error("{file}: {reason}")]
    ParameterFile { file: String, reason: String },
    #[error("parameter {name} is {found}: allowed are {allowed}")]
    Parameter {
        name: String,
        found: String,
        allowed: String,
    },
    #[error("the saved pose in {file} cannot be used: {reason}")]
    SavedPose { file: String, reason: String },
    #[error("the initial pose is in frame {found:?}: allowed is {allowed:?}")]
    InitialPoseFrame { found: String, allowed: String },
    #[error(
        "the covariance of the initial pose is none: allowed are finite, symmetric and positive \
         ones, and zeros where nobody knows"
    )]
    InitialPoseCovariance,
    #[error("the hash of the type {0} is not known")]
    UnknownType(String),
    #[error(transparent)]
    Map(#[from] map::MapError),
    #[error(transparent)]
    Network(#[from] NetworkError),
    #[error(transparent)]
    Key(#[from] KeyError),
    #[error("cannot {action} the domain of DDS: {reason}")]
    Dds {
        action: &'static str,
        reason: String,
    },
    #[error("the message for {topic} cannot be sent: {reason}")]
    Send { topic: String, reason: String },
    #[error("the message of {topic} has {found} bytes: allowed are at most {most}")]
    TooLong {
        topic: String,
        found: usize,
        most: usize,
    },
    #[error(
        "the attachment of {topic} has {found} bytes: allowed are the 33 of rmw_zenoh (sequence \
         number, time, sender)"
    )]
    Attachment { topic: String, found: usize },
    #[error("the message of {topic} cannot be read: {reason}")]
    Message { topic: String, reason: String },
    #[error("the message for {topic} cannot be written: {reason}")]
    Encode { topic: String, reason: String },
    #[error(
        "there is a second node {0}: both answer its services and publish its transform; leave the \
         other one out of the launch file, or give this one another --node"
    )]
    SecondNode(String),
    #[error(transparent)]
    Output(#[from] command_line::OutputError),
    #[error(
        "another node publishes the transform from {parent} to {child} on {topic}, as this one does, \
         and poses jump between the two: stop the other one, as AMCL or a SLAM"
    )]
    SecondBroadcaster {
        parent: String,
        child: String,
        topic: String,
    },
    #[error("{field} of {topic} is {found}: allowed is a finite number")]
    Number {
        topic: String,
        field: &'static str,
        found: f64,
    },
    #[error(
        "the stamp of {topic} is {sec} s and {nanosec} ns: allowed are times from 1970 on, with \
         less than 1000000000 ns"
    )]
    Stamp {
        topic: String,
        sec: i32,
        nanosec: u32,
    },
    #[error("a stamp of {stamp_ns} ns: allowed are 0 to 2147483647999999999, the times of ROS")]
    Unstampable { stamp_ns: i64 },
    #[error(transparent)]
    Conversion(#[from] ConversionError),
    #[error("{node} publishes {topic} as {found}, which is not supported: expected is {expected}")]
    Stranger {
        node: String,
        topic: String,
        found: String,
        expected: String,
    },
    #[error("the transform from {parent} to {child} is ignored")]
    Transform {
        parent: String,
        child: String,
        source: ConversionError,
    },
    #[error(
        "the laser {laser} is tilted by {tilt_degrees:.1} degrees against {base}: allowed are at \
         most {}, also upside down",
        recording::MAX_TILT_DEGREES
    )]
    Tilted {
        laser: String,
        base: String,
        tilt_degrees: f64,
    },
    #[error(
        "no transform says where {frame}, the frame of the point cloud, sits on the robot: allowed \
         are clouds with a mount, by /tf_static or --cloud-mount"
    )]
    NoCloudMount { frame: String },
    #[error("a frame's name has {found} bytes: allowed are at most {most}")]
    FrameName { found: usize, most: usize },
    #[error("too many frames, {frame:?} is ignored: allowed are {most}")]
    Frames { frame: String, most: usize },
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

    /// Returns a function that converts the reason why a message of `topic` cannot be read.
    pub(crate) fn decoding<E: std::fmt::Display>(topic: &str) -> impl FnOnce(E) -> Self {
        move |reason| GatewayError::Message {
            topic: topic.to_owned(),
            reason: reason.to_string(),
        }
    }

    /// Returns a function that converts an error of sending a message for `topic`.
    pub(crate) fn sending<E: std::fmt::Display>(topic: &str) -> impl FnOnce(E) -> Self {
        move |error| GatewayError::Send {
            topic: topic.to_owned(),
            reason: error.to_string(),
        }
    }
}
