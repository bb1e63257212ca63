//! Converts the records of a recording to messages of the graph, in their order.
//!
//! The recording is already open. Only the selected channels are read.

use std::collections::BTreeMap;
use std::sync::Arc;

use geometry::Mount;
use messages::{GroundTruth, Name, Odometry, ScanHeader};
use recording::{Kind, Message, Mounted, Record, Recording, RecordingError, Records};
use ros::{lasers, measurements};

use crate::replay::PlaybackError;
use crate::replay::selection::Selection;

#[derive(Debug, Clone, PartialEq)]
pub struct Timed {
    /// Time of recording, in nanoseconds since 1970.
    pub log_time_ns: i64,
    pub content: Content,
}

/// Content of a message; its stamp has no counter and no time of entering the graph yet.
#[derive(Debug, Clone, PartialEq)]
pub enum Content {
    Scan(Box<ScanHeader>, Vec<f32>),
    Odometry(Box<Odometry>),
    GroundTruth(Box<GroundTruth>),
}

impl Timed {
    pub fn is_scan(&self) -> bool {
        matches!(self.content, Content::Scan(..))
    }

    pub fn is_odometry(&self) -> bool {
        matches!(self.content, Content::Odometry(_))
    }

    /// Time up to which the robot's motion matters for the scan, in nanoseconds: that of its last
    /// beam if the scan takes time, its stamp if it is one of several lasers.
    pub fn motion_until_ns(&self) -> Option<i64> {
        let Content::Scan(header, ranges) = &self.content else {
            return None;
        };
        let steps = ranges.len().saturating_sub(1) as f64;
        let duration_ns = (header.time_increment_s * steps * 1e9) as i64;
        let matters = duration_ns != 0 || !header.laser.as_str().is_empty();
        matters.then(|| self.stamp_ns().saturating_add(duration_ns.max(0)))
    }

    /// Time of measurement, in nanoseconds since 1970.
    pub fn stamp_ns(&self) -> i64 {
        match &self.content {
            Content::Scan(header, _) => header.stamp.measured_ns,
            Content::Odometry(odometry) => odometry.stamp.measured_ns,
            Content::GroundTruth(truth) => truth.stamp.measured_ns,
        }
    }
}

#[derive(Debug, Clone)]
pub struct Channels {
    /// Topic and name of each laser, the first one first; a single laser has an empty name.
    scans: Vec<(Arc<str>, Name)>,
    odometry: Option<Arc<str>>,
    truth: Option<Arc<str>>,
}

impl Channels {
    pub fn of(recording: &Recording, selection: &Selection) -> Result<Self, RecordingError> {
        let topic = |kind| recording.topic_renamed(kind, |topic| selection.name_of(topic));
        let no_scans = || recording.no_topic(Kind::Scan);
        Ok(Channels {
            scans: vec![(topic(Kind::Scan)?.ok_or_else(no_scans)?, Name::new(""))],
            odometry: topic(Kind::Odometry)?,
            truth: topic(Kind::PoseStamped)?,
        })
    }

    /// Returns the channels of the selection, with the scans of several lasers: each is named by
    /// its topic, and the scans of the first one are answered.
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

    /// Number of readable scans of the first laser.
    pub fn scans(&self, recording: &Recording) -> u64 {
        let channels = recording.channels();
        let scans = channels.filter(|channel| self.is_first(&channel.topic));
        scans.map(|channel| channel.messages).sum()
    }

    /// Laser whose scans are answered; a single laser has an empty name.
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

/// Messages by log time; damage of the file is the last item.
pub struct Source<'a> {
    recording: &'a Recording,
    channels: Channels,
    selection: Selection,
    records: Records<'a>,
    mounts: BTreeMap<String, Option<Mount>>,
}

impl<'a> Source<'a> {
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
        let unusable = |reason| PlaybackError::Message {
            topic: (*record.topic).into(),
            log_time_ns: record.log_time_ns,
            reason,
        };
        let content = match record.message {
            Message::Scan(scan) => {
                let frame = measurements::frame(&scan.header.frame_id).map_err(unusable)?;
                let mount = self.mount(&scan.header.frame_id)?;
                let header = ScanHeader {
                    laser: self.channels.laser(&record.topic),
                    ..measurements::scan_header(&scan, frame, mount)
                };
                Content::Scan(Box::new(header), scan.ranges)
            }
            Message::Odometry(message) => {
                let odometry = measurements::odometry(&message).map_err(unusable)?;
                Content::Odometry(Box::new(odometry))
            }
            Message::PoseStamped(message) => {
                let truth = measurements::ground_truth(&message).map_err(unusable)?;
                Content::GroundTruth(Box::new(truth))
            }
            Message::Map(_) | Message::StaticTransforms(_) => return Ok(None),
        };
        Ok(Some(Timed {
            log_time_ns: record.log_time_ns,
            content,
        }))
    }

    /// Mount of the laser with this frame; looked up once.
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
                Err(error) if error.topic().is_some_and(|of| !self.channels.has(of)) => continue,
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
