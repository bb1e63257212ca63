//! Errors of reading, using and writing a recording.

use std::io;
use std::path::{Path, PathBuf};

use ros::{Cloud, ConversionError};

use crate::{Damage, Kind, topics};

/// An error of a recording, with the file that it concerns.
#[derive(Debug, thiserror::Error)]
pub enum RecordingError {
    /// The file does not exist or cannot be read.
    #[error("cannot read the recording {}", path.display())]
    Open {
        path: PathBuf,
        /// Error of the system.
        source: io::Error,
    },
    /// The file is truncated or damaged, or is no recording.
    #[error("{}: {damage}; {readable} messages before that are readable", path.display())]
    Damaged {
        path: PathBuf,
        /// Messages of all channels that come before the damage.
        readable: u64,
        damage: Damage,
    },
    /// A known file format that is not supported.
    #[error("{} is {what}: {advice}", path.display())]
    Foreign {
        path: PathBuf,
        /// Name of the format.
        what: &'static str,
        /// Advice on how to convert it.
        advice: String,
    },
    /// A compressed file that cannot be decompressed.
    #[error("{} cannot be unpacked: {reason}", path.display())]
    Unpack {
        path: PathBuf,
        /// Message of zstd or of the system, or the limit that is exceeded.
        reason: String,
    },
    /// A rosbag2 bag with missing files, or an SQLite bag that cannot be read or whose content is
    /// invalid.
    #[error("the bag {}: {reason}", path.display())]
    Bag {
        path: PathBuf,
        /// Message of SQLite, or the rule that is broken.
        reason: String,
    },
    /// A channel of a decodable type whose messages are not encoded in CDR.
    #[error("{}: {topic} has {schema} encoded as {encoding:?}; allowed: \"cdr\", as ROS 2 writes it", path.display())]
    NotCdr {
        path: PathBuf,
        topic: String,
        /// Schema name of the channel.
        schema: String,
        /// Encoding of its messages.
        encoding: String,
    },
    /// A message cannot be decoded by its schema.
    #[error("{}: the message of {topic} at log time {log_time_ns} ns is not a {kind}: {reason}", path.display())]
    Message {
        path: PathBuf,
        topic: String,
        /// Nanoseconds since 1970.
        log_time_ns: i64,
        /// Expected kind.
        kind: Kind,
        reason: String,
    },
    /// A message decodes, but cannot be used.
    #[error("{}: the message of {topic} at log time {log_time_ns} ns cannot be used", path.display())]
    Unusable {
        path: PathBuf,
        topic: String,
        /// Nanoseconds since 1970.
        log_time_ns: i64,
        source: ConversionError,
    },
    /// The recording has no messages of the requested kind.
    #[error("{} has no {kind}; it has {}{}", path.display(), listed(found), way_out(*kind, found))]
    NoTopic {
        path: PathBuf,
        kind: Kind,
        /// All channels of the recording, with their schemas.
        found: Vec<String>,
    },
    /// The recording has no messages of the kind on the named channel.
    #[error("{} has no {kind} on {topic}; it has {}", path.display(), listed(found))]
    NoSuchTopic {
        path: PathBuf,
        kind: Kind,
        topic: String,
        /// Channels with messages of the kind.
        found: Vec<String>,
    },
    /// Several channels have messages of the kind, none with the conventional name.
    #[error("{} has several channels of {kind}, {}, and none is called {name}: name one with {}", path.display(), listed(found), topics::option(*kind))]
    SeveralTopics {
        path: PathBuf,
        kind: Kind,
        /// Conventional name of the kind.
        name: &'static str,
        /// Channels with messages of the kind.
        found: Vec<String>,
    },
    /// The recording has no point clouds on the named channel.
    #[error("{} has no point cloud on {topic}; it has {}", path.display(), listed(found))]
    NoCloud {
        path: PathBuf,
        topic: String,
        /// All channels of the recording, with their schemas.
        found: Vec<String>,
    },
    /// A lidar whose height and tilt are not known.
    #[error("{}: no transform says where {frame:?}, the frame of {topic}, sits on the robot: give its pose by --cloud-mount X,Y,Z,YAW_DEG", path.display())]
    NoCloudMount {
        path: PathBuf,
        topic: String,
        /// Frame of the point clouds.
        frame: String,
    },
    /// A laser whose mount depends on an invalid transform.
    #[error("{}: the mount of {laser} is not known, for the transform {transform} is invalid: {reason}", path.display())]
    BrokenMount {
        path: PathBuf,
        /// Frame of the laser.
        laser: String,
        /// Frames of the transform, from and to.
        transform: String,
        reason: String,
    },
    /// A laser that is neither level nor upside down.
    #[error("{}: {laser} is tilted by {tilt_degrees:.0} degrees against {base}; allowed: 10, also upside down, for what it sees is not the plane of the map", path.display())]
    TiltedLaser {
        path: PathBuf,
        /// Frame of the laser.
        laser: String,
        /// Base frame.
        base: String,
        /// Angle between their z axes, or to the opposite axis if that is smaller, in degrees.
        tilt_degrees: f64,
    },
    /// Two ground truths with the same stamp that differ.
    #[error("{}: two ground truths are stamped {stamp_ns} ns, and differ", path.display())]
    TwoTruths {
        path: PathBuf,
        /// Nanoseconds since 1970.
        stamp_ns: i64,
    },
    /// A recording cannot be written.
    #[error("cannot write the recording: {reason}")]
    Write {
        /// Message of the system or the library, or the rule that is broken.
        reason: String,
    },
}

impl RecordingError {
    /// Returns a function that converts an error of reading the file.
    pub(crate) fn open(path: &Path) -> impl Fn(io::Error) -> Self + Copy {
        move |source| RecordingError::Open {
            path: path.to_owned(),
            source,
        }
    }
}

/// Returns what to do with a recording whose only lasers are in point clouds, if that is so.
fn way_out(kind: Kind, found: &[String]) -> String {
    let cloud = found.iter().find_map(|channel| {
        let (topic, schema) = channel.strip_suffix(')')?.split_once(" (")?;
        Cloud::is_schema(schema).then_some(topic)
    });
    match cloud {
        Some(topic) if kind == Kind::Scan => format!(
            ". It has point clouds and no laser scans: --cloud-topic {topic} takes one as the laser"
        ),
        _ => String::new(),
    }
}

fn listed(found: &[String]) -> String {
    match found {
        [] => "no channels".to_owned(),
        found => found.join(", "),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn point_clouds_alone_have_a_way_out() {
        let clouds = ["/a (sensor_msgs/msg/PointCloud2)".to_owned()];
        assert!(way_out(Kind::Scan, &clouds).contains("--cloud-topic /a takes"));
        assert_eq!(way_out(Kind::Map, &clouds), "");
        assert_eq!(way_out(Kind::Scan, &["/a (b/msg/C)".to_owned()]), "");
    }
}
