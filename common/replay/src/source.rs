//! From the records of a recording to messages of the graph, in their order.
//!
//! Pure: the recording is open already. It chooses the channels and leaves out
//! all others.

use std::collections::BTreeMap;
use std::sync::Arc;

use geometry::Mount;
use messages::{GroundTruth, Name, Odometry, ScanHeader};
use recording::{Channel, Kind, Message, Mounted, Record, Recording, RecordingError, Records};
use ros::lasers;
use ros::measurements::scan_header;

use crate::PlaybackError;
use crate::convert::Place;
use crate::selection::Selection;

/// A message that is ready but for its moment.
#[derive(Debug, Clone, PartialEq)]
pub struct Timed {
    /// When it was recorded, nanoseconds.
    pub log_time_ns: i64,
    /// The message.
    pub content: Content,
}

/// What it says.
#[derive(Debug, Clone, PartialEq)]
pub enum Content {
    /// Without its counter and its entry into the graph.
    Scan(Box<ScanHeader>, Vec<f32>),
    /// Likewise.
    Odometry(Box<Odometry>),
    /// Likewise.
    GroundTruth(Box<GroundTruth>),
}

impl Timed {
    /// Whether it is a scan.
    #[must_use]
    pub fn is_scan(&self) -> bool {
        matches!(self.content, Content::Scan(..))
    }

    /// Whether it is odometry.
    #[must_use]
    pub fn is_odometry(&self) -> bool {
        matches!(self.content, Content::Odometry(_))
    }

    /// Until when the robot's motion matters to the scan, nanoseconds: its last beam
    /// where it takes time, its stamp where it is one of several.
    #[must_use]
    pub fn motion_until_ns(&self) -> Option<i64> {
        let Content::Scan(header, ranges) = &self.content else {
            return None;
        };
        let steps = ranges.len().saturating_sub(1) as f64;
        let duration_ns = (header.time_increment_s * steps * 1e9) as i64;
        let matters = duration_ns != 0 || !header.laser.as_str().is_empty();
        matters.then(|| self.stamp_ns().saturating_add(duration_ns.max(0)))
    }

    /// When it was measured, nanoseconds.
    #[must_use]
    pub fn stamp_ns(&self) -> i64 {
        match &self.content {
            Content::Scan(header, _) => header.stamp.measured_ns,
            Content::Odometry(odometry) => odometry.stamp.measured_ns,
            Content::GroundTruth(truth) => truth.stamp.measured_ns,
        }
    }
}

/// The channels that are played.
#[derive(Debug, Clone)]
pub struct Channels {
    /// Of one laser, or of several by their names, the first one first.
    scans: Vec<(Arc<str>, Name)>,
    odometry: Option<Arc<str>>,
    truth: Option<Arc<str>>,
}

impl Channels {
    /// Those of the selection.
    ///
    /// # Errors
    /// If there are no scans, or it is not clear which ones are meant.
    pub fn of(recording: &Recording, selection: &Selection) -> Result<Self, RecordingError> {
        let topic = |kind| recording.topic_renamed(kind, |topic| selection.name_of(topic));
        let describe = |channel: &Channel| format!("{} ({})", channel.topic, channel.schema);
        let no_scans = || RecordingError::NoTopic {
            path: recording.path().to_owned(),
            kind: Kind::Scan,
            found: recording.channels().map(describe).collect(),
        };
        Ok(Channels {
            scans: vec![(topic(Kind::Scan)?.ok_or_else(no_scans)?, Name::new(""))],
            odometry: topic(Kind::Odometry)?,
            truth: topic(Kind::PoseStamped)?,
        })
    }

    /// Those of the selection, with the scans of these lasers: each is named by its
    /// topic, and the first one's scans are those that are answered.
    ///
    /// # Errors
    /// If one has no scans.
    pub fn of_lasers(
        recording: &Recording,
        selection: &Selection,
        topics: &[String],
    ) -> Result<Self, RecordingError> {
        let channels = Channels::of(recording, selection)?;
        if topics.len() < 2 {
            return Ok(channels);
        }
        let laser = |topic: &String| {
            let name = Name::new(&lasers::name_of(topic));
            (topic.as_str().into(), name)
        };
        Ok(Channels {
            scans: topics.iter().map(laser).collect(),
            ..channels
        })
    }

    /// Readable scans of the first laser.
    #[must_use]
    pub fn scans(&self, recording: &Recording) -> u64 {
        let channels = recording.channels();
        let scans = channels.filter(|channel| self.is_first(&channel.topic));
        scans.map(|channel| channel.messages).sum()
    }

    /// The laser whose scans are answered; without a name where there is one.
    #[must_use]
    pub fn first_laser(&self) -> Name {
        let first = self.scans.first();
        first.map_or(Name::new(""), |(_, laser)| *laser)
    }

    fn is_first(&self, topic: &str) -> bool {
        let first = self.scans.first();
        first.is_some_and(|(first, _)| **first == *topic)
    }

    fn has(&self, topic: &str) -> bool {
        let scans = self.scans.iter().map(|(topic, _)| topic);
        let others = [&self.odometry, &self.truth].into_iter().flatten();
        scans.chain(others).any(|name| **name == *topic)
    }

    fn laser(&self, topic: &str) -> Name {
        let mut scans = self.scans.iter();
        let found = scans.find(|(name, _)| **name == *topic);
        found.map_or(Name::new(""), |(_, laser)| *laser)
    }
}

/// The messages by log time; damage of the file is the last item.
pub struct Source<'a> {
    recording: &'a Recording,
    channels: Channels,
    selection: Selection,
    records: Records<'a>,
    mounts: BTreeMap<String, Option<Mount>>,
}

impl<'a> Source<'a> {
    /// Before the first of them.
    #[must_use]
    pub fn new(recording: &'a Recording, channels: Channels, selection: Selection) -> Self {
        Source {
            recording,
            channels,
            selection,
            records: recording.records_of(&[Kind::Scan, Kind::Odometry, Kind::PoseStamped]),
            mounts: BTreeMap::new(),
        }
    }

    fn convert(&mut self, record: Record) -> Result<Option<Timed>, PlaybackError> {
        let place = Place {
            topic: &record.topic,
            log_time_ns: record.log_time_ns,
        };
        let content = match record.message {
            Message::Scan(scan) => {
                let frame = place.name(&scan.header.frame_id)?;
                let mount = self.mount(&scan.header.frame_id)?;
                let header = ScanHeader {
                    laser: self.channels.laser(&record.topic),
                    ..scan_header(&scan, frame, mount)
                };
                Content::Scan(Box::new(header), scan.ranges)
            }
            Message::Odometry(message) => Content::Odometry(Box::new(place.odometry(&message)?)),
            Message::PoseStamped(message) => {
                Content::GroundTruth(Box::new(place.ground_truth(&message)?))
            }
            Message::Map(_) | Message::StaticTransforms(_) => return Ok(None),
        };
        Ok(Some(Timed {
            log_time_ns: record.log_time_ns,
            content,
        }))
    }

    /// Where the laser of this frame sits; looked up once.
    fn mount(&mut self, frame: &str) -> Result<Option<Mount>, RecordingError> {
        if let Some(&known) = self.mounts.get(frame) {
            return Ok(known);
        }
        let Mounted { mount, notes } = self.recording.mounted(frame)?;
        for note in notes {
            tracing::warn!("{note}");
        }
        let mount = mount.as_ref().map(Mount::from);
        self.mounts.insert(frame.into(), mount);
        Ok(mount)
    }
}

impl Iterator for Source<'_> {
    type Item = Result<Timed, PlaybackError>;

    fn next(&mut self) -> Option<Self::Item> {
        loop {
            let converted = match self.records.next()? {
                Ok(record) if !self.channels.has(&record.topic) => continue,
                Ok(record) if !self.selection.covers(record.log_time_ns) => continue,
                Err(
                    RecordingError::Message { topic, .. } | RecordingError::NotCdr { topic, .. },
                ) if !self.channels.has(&topic) => {
                    continue;
                }
                Err(RecordingError::Message { log_time_ns, .. })
                    if !self.selection.covers(log_time_ns) =>
                {
                    continue;
                }
                Ok(record) => self.convert(record).transpose(),
                Err(error) => Some(Err(error.into())),
            };
            if converted.is_some() {
                return converted;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use geometry::Pose;
    use recording::write::{Packing, RecordingWriter};
    use ros::{LaserScan, PoseStamped, Time};

    use super::*;

    const SECOND: i64 = 1_000_000_000;

    fn header(second: i32, frame: &str) -> ros::Header {
        ros::Header {
            stamp: Time {
                sec: second,
                nanosec: 5,
            },
            frame_id: frame.into(),
        }
    }

    fn scan(second: i32, frame: &str) -> Message {
        Message::Scan(LaserScan {
            header: header(second, frame),
            angle_min: -1.5,
            angle_increment: 0.25,
            range_max: 80.0,
            ranges: vec![1.0, f32::NAN, f32::INFINITY, -1.0],
            ..LaserScan::default()
        })
    }

    fn truth(second: i32) -> Message {
        Message::PoseStamped(PoseStamped {
            header: header(second, "map"),
            pose: ros::Pose::from_planar(Pose::new(1.0, 2.0, 0.5)),
        })
    }

    fn recording(messages: &[(&str, Message)]) -> Recording {
        let mut writer = RecordingWriter::in_memory(Packing::Zstd).unwrap();
        for (second, (topic, message)) in (0..).zip(messages) {
            writer.write(topic, second * SECOND, message).unwrap();
        }
        let bytes = writer.finish().unwrap().into_inner();
        Recording::from_bytes("world.mcap", bytes).unwrap()
    }

    fn play(recording: &Recording) -> Vec<Result<Timed, PlaybackError>> {
        let all = Selection::all();
        Source::new(recording, Channels::of(recording, &all).unwrap(), all).collect()
    }

    #[test]
    fn readings_pass_as_they_are_and_the_mount_comes_with_them() {
        let transform = ros::TransformStamped {
            header: header(0, "base_link"),
            child_frame_id: "laser".into(),
            transform: ros::Transform {
                translation: ros::Vector3 {
                    x: 0.78,
                    ..ros::Vector3::default()
                },
                ..ros::Transform::default()
            },
        };
        let transforms = ros::TfMessage {
            transforms: vec![transform],
        };
        let recording = recording(&[
            ("/scan", scan(7, "laser")),
            ("/tf_static", Message::StaticTransforms(transforms)),
            ("/scan", scan(8, "elsewhere")),
        ]);
        let played = play(&recording);
        let Ok(Timed {
            content: Content::Scan(header, ranges),
            log_time_ns: 0,
        }) = &played[0]
        else {
            panic!("{played:?}");
        };
        assert_eq!(header.stamp.measured_ns, 7 * SECOND + 5);
        assert_eq!((header.angle_min, header.angle_increment), (-1.5, 0.25));
        assert_eq!((header.range_max_m, header.frame.as_str()), (80.0, "laser"));
        assert_eq!((header.base_from_laser.x, header.mount_known), (0.78, 1));
        assert_eq!(
            (ranges[0], ranges[2], ranges[3]),
            (1.0, f32::INFINITY, -1.0)
        );
        assert!(ranges[1].is_nan());
        let Ok(Timed {
            content: Content::Scan(header, _),
            ..
        }) = &played[1]
        else {
            panic!("{played:?}");
        };
        assert_eq!(header.mount_known, 0);
        assert_eq!(played.len(), 2);
    }

    #[test]
    fn only_the_channels_that_are_meant_are_played() {
        let recording = recording(&[
            ("/scan", scan(0, "laser")),
            ("/other_scan", scan(1, "laser")),
            ("/goal_pose", truth(2)),
            ("/ground_truth", truth(3)),
        ]);
        let played = play(&recording);
        let stamps: Vec<i64> = played
            .iter()
            .map(|timed| timed.as_ref().unwrap().stamp_ns())
            .collect();
        assert_eq!(stamps, [5, 3 * SECOND + 5]);
    }

    #[test]
    fn what_cannot_be_said_in_a_message_is_refused_one_by_one() {
        let turned = ros::Odometry {
            pose: ros::PoseWithCovariance {
                pose: ros::Pose {
                    orientation: ros::Quaternion {
                        w: f64::NAN,
                        ..ros::Quaternion::default()
                    },
                    ..ros::Pose::default()
                },
                ..ros::PoseWithCovariance::default()
            },
            ..ros::Odometry::default()
        };
        let recording = recording(&[
            ("/scan", scan(0, &"f".repeat(257))),
            ("/odom", Message::Odometry(Box::new(turned))),
            ("/scan", scan(2, "laser")),
        ]);
        let played = play(&recording);
        assert!(played[2].is_ok());
        for (refused, expected) in played
            .iter()
            .zip(["/scan at log time 0 ns cannot be used: the frame", "/odom"])
        {
            let error = refused.as_ref().unwrap_err();
            assert!(error.is_about_one_message());
            assert!(error.to_string().contains(expected), "{error}");
        }
    }

    #[test]
    fn a_recording_without_scans_says_what_it_has() {
        let recording = recording(&[("/ground_truth", truth(0))]);
        let text = Channels::of(&recording, &Selection::all())
            .unwrap_err()
            .to_string();
        for expected in ["world.mcap", "LaserScan", "/ground_truth"] {
            assert!(text.contains(expected), "{text}");
        }
    }
}
