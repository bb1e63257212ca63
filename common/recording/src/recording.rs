//! An open recording.

mod raw;
mod reading;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use crate::block::Block;
use crate::cloud::CloudLaser;
use crate::file::RecordedFile;
use crate::folder;
use crate::{AttachedFile, Channel, Damage, Kind, MetadataRecord, RecordingError, topics};

pub use raw::{RawRecord, RawRecords};
pub use reading::Records;

/// A recording whose channels are known and whose checksums have been verified: one file, or
/// several that are read as one.
#[derive(Debug, Default)]
pub struct Recording {
    path: PathBuf,
    files: Vec<RecordedFile>,
    /// Channels of all files; a topic in several files is listed once.
    channels: Vec<Channel>,
    attachments: Vec<AttachedFile>,
    metadata: Vec<MetadataRecord>,
    preferred: BTreeMap<Kind, Arc<str>>,
    cloud: Option<CloudLaser>,
}

impl Recording {
    /// Opens a file, or a rosbag2 folder with all its parts, and reads it once from start to end. A
    /// bag may also be given by its `metadata.yaml`. Files may be compressed with zstd; with the
    /// feature `rosbag2` they may also be in SQLite. The format of a file is detected from its
    /// content.
    ///
    /// A truncated or damaged file opens up to the damage, which is the last item of
    /// [`Recording::records`]; an SQLite bag opens only without damage. The file is mapped: it may
    /// grow, but must not be truncated while it is open.
    pub fn open(path: impl AsRef<Path>) -> Result<Self, RecordingError> {
        Recording::open_all(&[path])
    }

    /// Opens several files or folders as one recording.
    pub fn open_all(paths: &[impl AsRef<Path>]) -> Result<Self, RecordingError> {
        let paths = || paths.iter().map(AsRef::as_ref);
        let (mut listed, mut seen) = (Vec::new(), Vec::new());
        for path in paths() {
            for file in folder::files(path)? {
                // A glob such as `drive/*` may match the parts as well as their `metadata.yaml`.
                let place = file.path.canonicalize();
                let place = place.unwrap_or_else(|_| file.path.clone());
                if !seen.contains(&place) {
                    seen.push(place);
                    listed.push(file);
                }
            }
        }
        let names: Vec<String> = paths().map(|path| path.display().to_string()).collect();
        let mut files = Vec::new();
        for file in &listed {
            // If there are several, one that does not even start as a recording counts as damage,
            // like the last part of a recorder that was killed.
            files.push(match RecordedFile::open(file) {
                Err(RecordingError::Damaged { path, damage, .. }) => {
                    RecordedFile::without_content(path, damage)
                }
                file => file?,
            });
        }
        let recording = Recording::of(names.join(" and ").into(), files);
        let mut files = recording.files.iter();
        match recording.damage_error() {
            Some(error) if files.all(RecordedFile::is_without_content) => Err(error),
            _ => Ok(recording),
        }
    }

    /// Opens a recording in memory; errors call it `name`.
    pub fn from_bytes(name: impl Into<PathBuf>, bytes: Vec<u8>) -> Result<Self, RecordingError> {
        let name = name.into();
        let file = RecordedFile::from_bytes(name.clone(), bytes)?;
        Ok(Recording::of(name, vec![file]))
    }

    fn of(path: PathBuf, files: Vec<RecordedFile>) -> Self {
        let mut recording = Recording {
            path,
            ..Recording::default()
        };
        for (index, file) in files.iter().enumerate() {
            for channel in file.survey.registry.channels() {
                recording.list(channel, index);
            }
            let extras = &file.survey.extras;
            let attachments = extras.attachments.iter().map(|attached| AttachedFile {
                file: index,
                ..attached.clone()
            });
            recording.attachments.extend(attachments);
            recording.metadata.extend(extras.metadata.iter().cloned());
        }
        recording.files = files;
        recording
    }

    /// Adds a channel of file number `file`. A channel that one file defines twice is listed twice.
    fn list(&mut self, channel: &Channel, file: usize) {
        let is_same = |other: &&mut Channel| {
            other.topic == channel.topic
                && other.schema == channel.schema
                && other.encoding == channel.encoding
        };
        match self.channels.iter_mut().find(is_same) {
            Some(same) if file > 0 => same.messages += channel.messages,
            _ => self.channels.push(channel.clone()),
        }
    }

    /// Path of the file or folder; for several, their names joined.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Size of its files in bytes, after decompression.
    pub fn size(&self) -> u64 {
        let sizes = self.files.iter().map(|file| file.bytes().len() as u64);
        sizes.sum()
    }

    pub fn file_count(&self) -> usize {
        self.files.len()
    }

    /// All channels, also those whose messages are only counted.
    pub fn channels(&self) -> impl Iterator<Item = &Channel> {
        self.channels.iter()
    }

    pub fn attachments(&self) -> &[AttachedFile] {
        &self.attachments
    }

    /// Content of an attachment from [`Recording::attachments`]; empty for one of another recording,
    /// or if the file was cut since it was opened.
    pub fn content_of(&self, attached: &AttachedFile) -> &[u8] {
        let end = attached.bytes.end;
        let file = self.files.get(attached.file);
        let file = file.filter(|file| file.ensure_long(end, attached.bytes.start).is_ok());
        let bytes = file.and_then(|file| file.bytes().get(attached.bytes.clone()));
        bytes.unwrap_or_default()
    }

    pub fn metadata(&self) -> &[MetadataRecord] {
        &self.metadata
    }

    /// Number of chunks with messages.
    pub fn chunks(&self) -> usize {
        self.blocks().filter(|block| block.is_chunk).count()
    }

    /// Number of messages with an earlier log time than the one before them in their chunk.
    pub fn unsorted(&self) -> u64 {
        self.blocks().map(|block| block.unsorted).sum()
    }

    fn blocks(&self) -> impl Iterator<Item = &Block> {
        self.files.iter().flat_map(|file| &file.survey.blocks)
    }

    /// Number of readable messages on all channels.
    pub fn messages(&self) -> u64 {
        self.files.iter().map(|file| file.survey.messages).sum()
    }

    /// Log times of the first and the last readable message, nanoseconds since
    /// 1970.
    pub fn time_range_ns(&self) -> Option<(i64, i64)> {
        let ranges = || self.files.iter().filter_map(|f| f.survey.time_range_ns());
        let first = ranges().map(|(first, _)| first).min()?;
        let last = ranges().map(|(_, last)| last).max()?;
        Some((first, last))
    }

    /// Damage of the first damaged file; `None` if all are sound.
    pub fn damage(&self) -> Option<&Damage> {
        let mut files = self.files.iter();
        files.find_map(|file| file.survey.damage.as_ref())
    }

    /// Same as [`Recording::damage`], as an error that names the file.
    pub fn damage_error(&self) -> Option<RecordingError> {
        let mut files = self.files.iter();
        let file = files.find(|file| file.survey.damage.is_some())?;
        let damage = file.survey.damage.clone()?;
        Some(RecordingError::Damaged {
            path: file.path.clone(),
            readable: self.messages(),
            damage,
        })
    }

    /// Iterates over all decodable messages by log time, then returns the damage if there is any.
    pub fn records(&self) -> Records<'_> {
        self.records_of(&Kind::ALL)
    }

    /// Same as [`Recording::records`], for messages of the given kinds only.
    pub fn records_of(&self, kinds: &[Kind]) -> Records<'_> {
        Records::new(self, kinds, self.damage_error())
    }

    /// Iterates over the undecoded messages of all channels by log time, then returns the damage if
    /// there is any.
    pub fn raw_records(&self) -> RawRecords<'_> {
        RawRecords::new(self, |_| true, self.damage_error())
    }

    /// Makes `topic` the channel to use for messages of this kind from now on.
    pub fn prefer(&mut self, kind: Kind, topic: &str) -> Result<(), RecordingError> {
        let of_kind = |c: &&Channel| c.kind == Some(kind) && c.messages > 0;
        let mut channels = self.channels.iter().filter(of_kind);
        let Some(channel) = channels.clone().find(|channel| &*channel.topic == topic) else {
            let found: Vec<String> = channels.by_ref().map(|c| c.topic.to_string()).collect();
            return Err(RecordingError::lacks(
                &self.path,
                &kind.to_string(),
                topic,
                &found,
            ));
        };
        self.preferred.insert(kind, channel.topic.clone());
        Ok(())
    }

    /// Selects the channel with messages of a kind: the preferred one, the only one, or the one
    /// with the conventional name; `None` if there is none. Poses are only accepted under the
    /// conventional name.
    pub fn topic(&self, kind: Kind) -> Result<Option<Arc<str>>, RecordingError> {
        self.topic_renamed(kind, |topic| Some(topic.to_owned()))
    }

    /// Same as [`Recording::topic`] with renamed channels: `name_of` returns the new name of a
    /// channel, or `None` to exclude it. The result is the channel's own name.
    pub fn topic_renamed(
        &self,
        kind: Kind,
        name_of: impl Fn(&str) -> Option<String>,
    ) -> Result<Option<Arc<str>>, RecordingError> {
        if let Some(topic) = self.preferred.get(&kind) {
            return Ok(Some(topic.clone()));
        }
        topics::choose(self.channels(), name_of, kind, &self.path)
    }

    /// Same as [`Recording::topic`], but a missing channel is an error.
    pub fn required_topic(&self, kind: Kind) -> Result<Arc<str>, RecordingError> {
        self.topic(kind)?.ok_or_else(|| self.no_topic(kind))
    }

    pub fn no_topic(&self, kind: Kind) -> RecordingError {
        RecordingError::NoTopic {
            path: self.path.clone(),
            kind,
            found: self.described_channels(),
        }
    }

    /// Topics of all channels, with their schemas.
    pub(crate) fn described_channels(&self) -> Vec<String> {
        let describe = |channel: &Channel| format!("{} ({})", channel.topic, channel.schema);
        self.channels().map(describe).collect()
    }

    pub(crate) fn definitions(&self) -> BTreeMap<String, String> {
        let files = self.files.iter();
        files
            .flat_map(|file| file.survey.registry.definitions())
            .collect()
    }

    pub(crate) fn cloud(&self) -> Option<&CloudLaser> {
        self.cloud.as_ref()
    }

    /// Has the point clouds of a topic decoded as the only scans.
    pub(crate) fn set_cloud(&mut self, topic: Arc<str>, cloud: CloudLaser) {
        for channel in &mut self.channels {
            channel.take_cloud(&topic);
        }
        for file in &mut self.files {
            file.survey.registry.take_cloud(&topic);
        }
        self.preferred.insert(Kind::Scan, topic);
        self.cloud = Some(cloud);
    }

    pub(crate) fn files(&self) -> &[RecordedFile] {
        &self.files
    }
}
