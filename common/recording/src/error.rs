//! Errors of reading, using and writing a recording.

use std::io;
use std::path::{Path, PathBuf};

use ros::{Cloud, ConversionError};

use crate::{Damage, Kind};

#[derive(Debug, thiserror::Error)]
pub enum RecordingError {
    #[error("cannot read the recording {}", path.display())]
    Open { path: PathBuf, source: io::Error },
    #[error("{}: {damage}; {readable} messages before that are readable", path.display())]
    Damaged {
        path: PathBuf,
        /// Messages of all channels that come before the damage.
        readable: u64,
        damage: Damage,
    },
    #[error("{} cannot be unpacked: {reason}", path.display())]
    Unpack { path: PathBuf, reason: String },
    /// A rosbag2 bag with missing files, or an SQLite bag that cannot be read or whose content is
    /// invalid.
    #[error("the bag {}: {reason}", path.display())]
    Bag { path: PathBuf, reason: String },
    #[error("{}: {topic} has {schema} encoded as {encoding:?}; allowed: \"cdr\", as ROS 2 writes it", path.display())]
    NotCdr {
        path: PathBuf,
        topic: String,
        schema: String,
        encoding: String,
    },
    #[error("{}: the message of {topic} at log time {log_time_ns} ns is not a {kind}: {reason}", path.display())]
    Message {
        path: PathBuf,
        topic: String,
        /// Nanoseconds since 1970.
        log_time_ns: i64,
        kind: Kind,
        reason: String,
    },
    #[error("{}: the message of {topic} at log time {log_time_ns} ns cannot be used", path.display())]
    Unusable {
        path: PathBuf,
        topic: String,
        /// Nanoseconds since 1970.
        log_time_ns: i64,
        source: ConversionError,
    },
    #[error("{} has no {kind}; it has {}{}", path.display(), listed(found), way_out(*kind, found))]
    NoTopic {
        path: PathBuf,
        kind: Kind,
        found: Vec<String>,
    },
    /// Recording without what is asked of it, by its name.
    #[error("{0}")]
    Unfit(String),
    #[error("cannot write the recording: {reason}")]
    Write { reason: String },
}

impl RecordingError {
    pub(crate) fn open(path: &Path) -> impl Fn(io::Error) -> Self + Copy {
        move |source| RecordingError::Open {
            path: path.to_owned(),
            source,
        }
    }

    /// Error of a recording without such messages on a topic, with the channels that it has.
    pub(crate) fn lacks(path: &Path, what: &str, topic: &str, found: &[String]) -> Self {
        let (path, found) = (path.display(), listed(found));
        RecordingError::Unfit(format!("{path} has no {what} on {topic}; it has {found}"))
    }

    /// Topic of the message that does not decode, if that is the error.
    pub fn topic(&self) -> Option<&str> {
        match self {
            RecordingError::Message { topic, .. } | RecordingError::NotCdr { topic, .. } => {
                Some(topic)
            }
            _ => None,
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
