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
mod tests;
