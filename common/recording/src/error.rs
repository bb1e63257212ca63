//! Errors of reading, using and writing a recording.

use std::io;
use std::path::PathBuf;

use ros::ConversionError;

use crate::{Damage, Kind, topics};

/// What went wrong, and in which file.
#[derive(Debug, thiserror::Error)]
pub enum RecordingError {
    /// The file is not there or not readable.
    #[error("cannot read the recording {}", path.display())]
    Open {
        /// The file.
        path: PathBuf,
        /// What the system says.
        source: io::Error,
    },
    /// The file is cut short or damaged, or no recording.
    #[error("{}: {damage}; {readable} messages before that are readable", path.display())]
    Damaged {
        /// The file.
        path: PathBuf,
        /// Messages of all channels that lie before the damage.
        readable: u64,
        /// What is wrong, and where.
        damage: Damage,
    },
    /// A kind of file that is known, but not read.
    #[error("{} is {what}: {advice}", path.display())]
    Foreign {
        /// The file.
        path: PathBuf,
        /// What it is.
        what: &'static str,
        /// How to make of it what is read.
        advice: String,
    },
    /// A packed file that cannot be unpacked.
    #[error("{} cannot be unpacked: {reason}", path.display())]
    Unpack {
        /// The file.
        path: PathBuf,
        /// What is wrong.
        reason: String,
    },
    /// A bag of rosbag2 whose files are not all there, or one in SQLite that cannot
    /// be read, or whose content is not sound.
    #[error("the bag {}: {reason}", path.display())]
    Bag {
        /// The file.
        path: PathBuf,
        /// What SQLite says, or what is not allowed.
        reason: String,
    },
    /// A channel of a type in use whose messages are encoded in another way.
    #[error("{}: {topic} has {schema} encoded as {encoding:?}; allowed: \"cdr\", as ROS 2 writes it", path.display())]
    NotCdr {
        /// The file.
        path: PathBuf,
        /// The channel.
        topic: String,
        /// Its schema's name.
        schema: String,
        /// How its messages are encoded.
        encoding: String,
    },
    /// A message does not decode as its schema says.
    #[error("{}: the message of {topic} at log time {log_time_ns} ns is not a {kind}: {reason}", path.display())]
    Message {
        /// The file.
        path: PathBuf,
        /// The channel.
        topic: String,
        /// Nanoseconds since 1970.
        log_time_ns: i64,
        /// What it should be.
        kind: Kind,
        /// What is wrong.
        reason: String,
    },
    /// A message decodes, but cannot be used.
    #[error("{}: the message of {topic} at log time {log_time_ns} ns cannot be used", path.display())]
    Unusable {
        /// The file.
        path: PathBuf,
        /// The channel.
        topic: String,
        /// Nanoseconds since 1970.
        log_time_ns: i64,
        /// What is wrong.
        source: ConversionError,
    },
    /// What was asked for is not in the recording.
    #[error("{} has no {kind}; it has {}", path.display(), listed(found))]
    NoTopic {
        /// The file.
        path: PathBuf,
        /// What was asked for.
        kind: Kind,
        /// The channels that it has, with their schemas.
        found: Vec<String>,
    },
    /// The channel that was named is not in the recording.
    #[error("{} has no {kind} on {topic}; it has {}", path.display(), listed(found))]
    NoSuchTopic {
        /// The file.
        path: PathBuf,
        /// What was asked for.
        kind: Kind,
        /// On which channel.
        topic: String,
        /// The channels that have some.
        found: Vec<String>,
    },
    /// Several channels could be meant.
    #[error("{} has several channels of {kind}, {}, and none is called {name}: name one with {}", path.display(), listed(found), topics::option(*kind))]
    SeveralTopics {
        /// The file.
        path: PathBuf,
        /// What was asked for.
        kind: Kind,
        /// The name that would be taken.
        name: &'static str,
        /// The channels.
        found: Vec<String>,
    },
    /// A laser whose place depends on a transform that is invalid.
    #[error("{}: the mount of {laser} is not known, for the transform {transform} is invalid: {reason}", path.display())]
    BrokenMount {
        /// The file.
        path: PathBuf,
        /// The laser's frame.
        laser: String,
        /// From which frame to which.
        transform: String,
        /// What is wrong.
        reason: String,
    },
    /// A laser that is neither level nor upside down.
    #[error("{}: {laser} is tilted by {tilt_degrees:.0} degrees against {base}; allowed: 10, also upside down, for what it sees is not the plane of the map", path.display())]
    TiltedLaser {
        /// The file.
        path: PathBuf,
        /// The laser's frame.
        laser: String,
        /// The base frame.
        base: String,
        /// Angle between their z axes, or to the opposite one if that is nearer.
        tilt_degrees: f64,
    },
    /// Two ground truths that contradict each other.
    #[error("{}: two ground truths are stamped {stamp_ns} ns, and differ", path.display())]
    TwoTruths {
        /// The file.
        path: PathBuf,
        /// Nanoseconds since 1970.
        stamp_ns: i64,
    },
    /// A recording could not be written.
    #[error("cannot write the recording: {reason}")]
    Write {
        /// What the system or the library says, or what is not allowed.
        reason: String,
    },
}

fn listed(found: &[String]) -> String {
    match found {
        [] => "no channels".to_owned(),
        found => found.join(", "),
    }
}
