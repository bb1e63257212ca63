//! Errors that end the gateway, and reasons to reject a message.

use ros::ConversionError;
use transport::TransportError;
use zenoh_session::{KeyError, NetworkError};

/// What was tried, what was found and what is allowed.
#[derive(Debug, thiserror::Error)]
pub enum GatewayError {
    /// An option cannot be used.
    #[error("--{option}: {reason}")]
    Option {
        /// The option's name.
        option: &'static str,
        /// What is wrong, and what is allowed.
        reason: String,
    },
    /// A file of parameters cannot be used.
    #[error("{file}: {reason}")]
    ParameterFile {
        /// Its path.
        file: String,
        /// What is wrong, and what is allowed.
        reason: String,
    },
    /// A parameter's value cannot be used.
    #[error("parameter {name} is {found}: allowed are {allowed}")]
    Parameter {
        /// The parameter.
        name: String,
        /// What it was to hold.
        found: String,
        /// What it may hold.
        allowed: String,
    },
    /// The file of the last pose cannot be used.
    #[error("the saved pose in {file} cannot be used: {reason}")]
    SavedPose {
        /// Its path.
        file: String,
        /// What is wrong, and what is allowed.
        reason: String,
    },
    /// An initial pose is in a frame that is not the map's.
    #[error("the initial pose is in frame {found:?}: allowed is {allowed:?}")]
    InitialPoseFrame {
        /// The frame of the pose.
        found: String,
        /// The map's.
        allowed: String,
    },
    /// An initial pose has a covariance that is none.
    #[error(
        "the covariance of the initial pose is none: allowed are finite, symmetric and positive \
         ones, and zeros where nobody knows"
    )]
    InitialPoseCovariance,
    /// A definition has a line that is no field.
    #[error("the definition of {name}: {line:?} is not a field")]
    Definition {
        /// The type.
        name: String,
        /// The line.
        line: String,
    },
    /// A map that the graph could not hold.
    #[error(transparent)]
    Map(#[from] map::MapError),
    /// The session cannot be opened.
    #[error(transparent)]
    Network(#[from] NetworkError),
    /// A key cannot be used.
    #[error(transparent)]
    Key(#[from] KeyError),
    /// DDS cannot be used.
    #[error("cannot {action} the domain of DDS: {reason}")]
    Dds {
        /// What was tried.
        action: &'static str,
        /// Why not.
        reason: String,
    },
    /// A message cannot be sent.
    #[error("the message for {topic} cannot be sent: {reason}")]
    Send {
        /// The robot's topic or service.
        topic: String,
        /// Why not.
        reason: String,
    },
    /// A message is longer than any sound one.
    #[error("the message of {topic} has {found} bytes: allowed are at most {most}")]
    TooLong {
        /// The robot's topic.
        topic: String,
        /// Its bytes.
        found: usize,
        /// Most bytes.
        most: usize,
    },
    /// What goes along with a message is not what `rmw_zenoh` sends.
    #[error(
        "the attachment of {topic} has {found} bytes: allowed are the 33 of rmw_zenoh (sequence \
         number, time, sender)"
    )]
    Attachment {
        /// The robot's topic or service.
        topic: String,
        /// Its bytes.
        found: usize,
    },
    /// A message is not in CDR, or not of its type.
    #[error("the message of {topic} cannot be read: {reason}")]
    Message {
        /// The robot's topic.
        topic: String,
        /// Why not.
        reason: String,
    },
    /// A message cannot be written in CDR.
    #[error("the message for {topic} cannot be written: {reason}")]
    Encode {
        /// The robot's topic.
        topic: String,
        /// Why not.
        reason: String,
    },
    /// Another node has this one's name.
    #[error(
        "there is a second node {0}: both answer its services and publish its transform; leave the \
         other one out of the launch file, or give this one another --node"
    )]
    SecondNode(String),
    /// Standard output takes no more.
    #[error(transparent)]
    Output(#[from] command_line::OutputError),
    /// Another node publishes the transform that the gateway publishes.
    #[error(
        "another node publishes the transform from {parent} to {child} on {topic}, as this one does, \
         and poses jump between the two: stop the other one, as AMCL or a SLAM"
    )]
    SecondBroadcaster {
        /// The frames of the other's transform.
        parent: String,
        /// The odometry's frame.
        child: String,
        /// The robot's topic.
        topic: String,
    },
    /// A number is none.
    #[error("{field} of {topic} is {found}: allowed is a finite number")]
    Number {
        /// The robot's topic.
        topic: String,
        /// The field.
        field: &'static str,
        /// What it holds.
        found: f64,
    },
    /// A time before 1970, or with a second in its nanoseconds.
    #[error(
        "the stamp of {topic} is {sec} s and {nanosec} ns: allowed are times from 1970 on, with \
         less than 1000000000 ns"
    )]
    Stamp {
        /// The robot's topic.
        topic: String,
        /// Seconds since 1970.
        sec: i32,
        /// Nanoseconds on top of them.
        nanosec: u32,
    },
    /// A time that no message of ROS can say.
    #[error("a stamp of {stamp_ns} ns: allowed are 0 to 2147483647999999999, the times of ROS")]
    Unstampable {
        /// Nanoseconds since 1970.
        stamp_ns: i64,
    },
    /// A pose, a transform or a map is invalid, or the graph cannot say it.
    #[error(transparent)]
    Conversion(#[from] ConversionError),
    /// A topic that is taken is published as something else.
    #[error("{node} publishes {topic} as {found}, which is not supported: expected is {expected}")]
    Stranger {
        /// The robot's node.
        node: String,
        /// The robot's topic.
        topic: String,
        /// Its type and hash.
        found: String,
        /// Those of the messages that are taken.
        expected: String,
    },
    /// A transform of `/tf_static` is none; the others of its message are taken.
    #[error("the transform from {parent} to {child} is ignored")]
    Transform {
        /// The parent frame.
        parent: String,
        /// The child frame.
        child: String,
        /// Why it is none.
        source: ConversionError,
    },
    /// A laser that does not look level.
    #[error(
        "the laser {laser} is tilted by {tilt_degrees:.1} degrees against {base}: allowed are at \
         most {}, also upside down",
        recording::MAX_TILT_DEGREES
    )]
    Tilted {
        /// The laser's frame.
        laser: String,
        /// The base's.
        base: String,
        /// Angle between their z axes.
        tilt_degrees: f64,
    },
    /// A frame's name that is invalid.
    #[error("a frame's name has {found} bytes: allowed are at most {most}")]
    FrameName {
        /// Its bytes.
        found: usize,
        /// Most bytes.
        most: usize,
    },
    /// More frames than a robot has.
    #[error("too many frames, {frame:?} is ignored: allowed are {most}")]
    Frames {
        /// The frame that was to come.
        frame: String,
        /// Most frames.
        most: usize,
    },
    /// The graph fails.
    #[error(transparent)]
    Transport(#[from] TransportError),
}
