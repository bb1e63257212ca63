//! An open recording.

mod raw;
mod reading;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use crate::block::{Block, Part};
use crate::file::RecordedFile;
use crate::folder::{self, Listed};
use crate::{AttachedFile, Channel, Damage, Kind, MetadataRecord, RecordingError, topics};

pub use raw::{RawRecord, RawRecords};
pub use reading::Records;

/// A recording whose channels are known and whose checksums have been compared:
/// one file, or several that are read as one.
#[derive(Debug)]
pub struct Recording {
    path: PathBuf,
    files: Vec<RecordedFile>,
    /// Those of all files; a topic of several files stands here once.
    channels: Vec<Channel>,
    attachments: Vec<AttachedFile>,
    metadata: Vec<MetadataRecord>,
    /// Channels that the user has named.
    preferred: BTreeMap<Kind, Arc<str>>,
}

impl Recording {
    /// Opens a file, or the folder of a bag of rosbag2 with all its parts, and
    /// reads it once from start to end. A bag may be named by its `metadata.yaml`,
    /// and files may be packed with zstd; with the feature `rosbag2` they may also
    /// be in SQLite. What a file holds is detected from its content.
    ///
    /// A file that is cut short or damaged opens as far as it is sound; the
    /// damage is the last item of [`Recording::records`]. The file is mapped:
    /// it may grow, but must not be cut while it is open.
    ///
    /// # Errors
    /// If it cannot be read, or does not even start as a recording; of a bag in
    /// SQLite, any damage.
    pub fn open(path: impl AsRef<Path>) -> Result<Self, RecordingError> {
        Recording::open_all(&[path])
    }

    /// Opens several files or folders as one recording.
    ///
    /// # Errors
    /// As [`Recording::open`]; nothing is named.
    pub fn open_all(paths: &[impl AsRef<Path>]) -> Result<Self, RecordingError> {
        let paths = || paths.iter().map(AsRef::as_ref);
        let (mut listed, mut seen) = (Vec::new(), Vec::new());
        for path in paths() {
            for file in folder::files(path)? {
                // As `drive/*` names the parts and the description of them.
                let place = file.path.canonicalize();
                let place = place.unwrap_or_else(|_| file.path.clone());
                if !seen.contains(&place) {
                    seen.push(place);
                    listed.push(file);
                }
            }
        }
        let names: Vec<String> = paths().map(|path| path.display().to_string()).collect();
        let files = opened(&listed)?;
        Ok(Recording::of(names.join(" and ").into(), files))
    }

    /// A recording in memory; errors call it `name`.
    ///
    /// # Errors
    /// If it does not even start as a recording.
    pub fn from_bytes(name: impl Into<PathBuf>, bytes: Vec<u8>) -> Result<Self, RecordingError> {
        let name = name.into();
        let file = RecordedFile::from_bytes(name.clone(), bytes)?;
        Ok(Recording::of(name, vec![file]))
    }

    fn of(path: PathBuf, files: Vec<RecordedFile>) -> Self {
        let mut recording = Recording {
            path,
            files: Vec::new(),
            channels: Vec::new(),
            attachments: Vec::new(),
            metadata: Vec::new(),
            preferred: BTreeMap::new(),
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

    /// Lists a channel of a file. What a file defines twice is listed twice.
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

    /// The file or folder; of several, their names.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The size of its files in bytes, once they are unpacked.
    #[must_use]
    pub fn size(&self) -> u64 {
        let sizes = self.files.iter().map(|file| file.bytes().len() as u64);
        sizes.sum()
    }

    /// How many files it has.
    #[must_use]
    pub fn file_count(&self) -> usize {
        self.files.len()
    }

    /// All channels, also those whose messages are only counted.
    pub fn channels(&self) -> impl Iterator<Item = &Channel> {
        self.channels.iter()
    }

    /// The files in it.
    #[must_use]
    pub fn attachments(&self) -> &[AttachedFile] {
        &self.attachments
    }

    /// The bytes of one of its [`Recording::attachments`]; none of another's.
    #[must_use]
    pub fn content_of(&self, attached: &AttachedFile) -> &[u8] {
        let file = self.files.get(attached.file);
        let bytes = file.and_then(|file| file.bytes().get(attached.bytes.clone()));
        bytes.unwrap_or_default()
    }

    /// What is said of it as a whole.
    #[must_use]
    pub fn metadata(&self) -> &[MetadataRecord] {
        &self.metadata
    }

    /// How its messages are packed: the parts of the files that hold them.
    pub fn parts(&self) -> impl Iterator<Item = Part> {
        let blocks = self.files.iter().flat_map(|file| &file.survey.blocks);
        blocks.map(Block::part)
    }

    /// Readable messages of all channels.
    #[must_use]
    pub fn messages(&self) -> u64 {
        self.files.iter().map(|file| file.survey.messages).sum()
    }

    /// Log times of the first and the last readable message, nanoseconds since
    /// 1970.
    #[must_use]
    pub fn time_range_ns(&self) -> Option<(i64, i64)> {
        let ranges = || self.files.iter().filter_map(|f| f.survey.time_range_ns());
        let first = ranges().map(|(first, _)| first).min()?;
        let last = ranges().map(|(_, last)| last).max()?;
        Some((first, last))
    }

    /// What is wrong with the first of its files that is damaged, if one is.
    #[must_use]
    pub fn damage(&self) -> Option<&Damage> {
        let mut files = self.files.iter();
        files.find_map(|file| file.survey.damage.as_ref())
    }

    /// As [`Recording::damage`], as an error that names the file.
    #[must_use]
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

    /// All messages that are read, by log time, then the damage if there is any.
    #[must_use]
    pub fn records(&self) -> Records<'_> {
        self.records_of(&Kind::ALL)
    }

    /// As [`Recording::records`], but only those of some kinds.
    #[must_use]
    pub fn records_of(&self, kinds: &[Kind]) -> Records<'_> {
        Records::new(self, kinds, self.damage_error())
    }

    /// The messages of all channels as they stand in the file, by log time, then
    /// the damage if there is any.
    #[must_use]
    pub fn raw_records(&self) -> RawRecords<'_> {
        RawRecords::new(self, |_| true, self.damage_error())
    }

    /// From now on, `topic` is meant wherever messages of this kind are asked for.
    ///
    /// # Errors
    /// If no channel of that name has messages of the kind.
    pub fn prefer(&mut self, kind: Kind, topic: &str) -> Result<(), RecordingError> {
        let of_kind = |c: &&Channel| c.kind == Some(kind) && c.messages > 0;
        let mut channels = self.channels.iter().filter(of_kind);
        let Some(channel) = channels.clone().find(|channel| &*channel.topic == topic) else {
            let found: Vec<String> = channels.by_ref().map(|c| c.topic.to_string()).collect();
            return Err(RecordingError::NoSuchTopic {
                path: self.path.clone(),
                kind,
                topic: topic.to_owned(),
                found,
            });
        };
        self.preferred.insert(kind, channel.topic.clone());
        Ok(())
    }

    /// The channel that holds messages of a kind: the preferred one, the only one,
    /// or the one with the conventional name; `None` where there is none. Poses are
    /// taken under that name alone.
    ///
    /// # Errors
    /// If several could be meant.
    pub fn topic(&self, kind: Kind) -> Result<Option<Arc<str>>, RecordingError> {
        if let Some(topic) = self.preferred.get(&kind) {
            return Ok(Some(topic.clone()));
        }
        let channels: Vec<&Channel> = self.channels().collect();
        let channel = topics::choose(&channels, kind, &self.path)?;
        Ok(channel.map(|channel| channel.topic.clone()))
    }

    /// As [`Recording::topic`], where channels go by other names: `name_of` gives
    /// that of each, or `None` for one that is not meant. The result is the
    /// channel's own name.
    ///
    /// # Errors
    /// If several could be meant.
    pub fn topic_renamed(
        &self,
        kind: Kind,
        name_of: impl Fn(&str) -> Option<String>,
    ) -> Result<Option<Arc<str>>, RecordingError> {
        if let Some(topic) = self.preferred.get(&kind) {
            return Ok(Some(topic.clone()));
        }
        let renamed = |channel: &Channel| {
            let topic = name_of(&channel.topic)?.into();
            let own = channel.topic.clone();
            let channel = Channel {
                topic,
                ..channel.clone()
            };
            Some((channel, own))
        };
        let renamed: Vec<(Channel, Arc<str>)> = self.channels().filter_map(renamed).collect();
        let channels: Vec<&Channel> = renamed.iter().map(|(channel, _)| channel).collect();
        let Some(chosen) = topics::choose(&channels, kind, &self.path)? else {
            return Ok(None);
        };
        let own = renamed
            .iter()
            .find(|(channel, _)| std::ptr::eq(channel, chosen));
        Ok(own.map(|(_, own)| own.clone()))
    }

    /// As [`Recording::topic`], where there must be one.
    ///
    /// # Errors
    /// If there is none, or several could be meant.
    pub fn required_topic(&self, kind: Kind) -> Result<Arc<str>, RecordingError> {
        let describe = |channel: &Channel| format!("{} ({})", channel.topic, channel.schema);
        self.topic(kind)?.ok_or_else(|| RecordingError::NoTopic {
            path: self.path.clone(),
            kind,
            found: self.channels().map(describe).collect(),
        })
    }

    /// The texts of the schemas that the files bring along, by their names.
    pub(crate) fn definitions(&self) -> BTreeMap<String, String> {
        let files = self.files.iter();
        files
            .flat_map(|file| file.survey.registry.definitions())
            .collect()
    }

    pub(crate) fn files(&self) -> &[RecordedFile] {
        &self.files
    }
}

/// Opens files. Where there are several, one that does not even start as a
/// recording is damage, as the last part of a recorder that was cut off is.
fn opened(listed: &[Listed]) -> Result<Vec<RecordedFile>, RecordingError> {
    let (mut files, mut failure) = (Vec::new(), None);
    for file in listed {
        match RecordedFile::open(file) {
            Ok(file) => files.push(file),
            Err(RecordingError::Damaged { path, damage, .. }) => {
                files.push(RecordedFile::without_content(path.clone(), damage.clone()));
                failure.get_or_insert(RecordingError::Damaged {
                    path,
                    readable: 0,
                    damage,
                });
            }
            Err(error) => return Err(error),
        }
    }
    match failure {
        Some(error) if files.iter().all(RecordedFile::is_without_content) => Err(error),
        _ => Ok(files),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::write::Packing;
    use crate::{Record, sample};

    #[test]
    fn channels_are_listed_with_their_counts() {
        let recording = Recording::from_bytes("r.mcap", sample::bytes(Packing::Plain)).unwrap();
        let mut channels: Vec<_> = recording
            .channels()
            .map(|channel| (&*channel.topic, channel.kind, channel.messages))
            .collect();
        channels.sort_unstable_by_key(|channel| channel.0);
        let scans = sample::SCANS as u64;
        assert_eq!(
            channels,
            [
                ("/ground_truth", Some(Kind::PoseStamped), scans),
                ("/map", Some(Kind::Map), 1),
                ("/odom", Some(Kind::Odometry), scans),
                ("/rosout", None, 1),
                ("/scan", Some(Kind::Scan), scans),
                ("/tf_static", Some(Kind::StaticTransforms), 1),
            ]
        );
        assert_eq!(recording.messages(), 3 * scans + 3);
    }

    #[test]
    fn a_file_opens_as_its_bytes_do() {
        let folder = tempfile::TempDir::new().unwrap();
        let path = folder.path().join("r.mcap");
        std::fs::write(&path, sample::bytes(Packing::Zstd)).unwrap();
        let opened = Recording::open(&path).unwrap();
        let records: Vec<Record> = opened.records().map(Result::unwrap).collect();
        assert_eq!(records, sample::records());
        std::fs::write(&path, b"").unwrap();
        let empty = Recording::open(&path).unwrap_err().to_string();
        assert!(empty.contains("starts with nothing"), "{empty}");
    }
}
