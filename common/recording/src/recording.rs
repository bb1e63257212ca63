//! An open recording.

use std::fs::File;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use memmap2::Mmap;

use crate::block::{Block, Part};
use crate::survey::Survey;
use crate::{
    AttachedFile, Channel, Damage, Kind, MetadataRecord, RawRecords, RecordingError, Records,
    topics,
};

/// A recording whose channels are known and whose checksums have been compared.
#[derive(Debug)]
pub struct Recording {
    path: PathBuf,
    bytes: Bytes,
    pub(crate) survey: Survey,
}

#[derive(Debug)]
enum Bytes {
    Mapped(Mmap),
    Owned(Vec<u8>),
}

impl Recording {
    /// Opens a file, or with the feature `rosbag2` a bag in SQLite or a folder of
    /// such, and reads it once from start to end.
    ///
    /// A file that is cut short or damaged opens as far as it is sound; the
    /// damage is the last item of [`Recording::records`]. The file is mapped:
    /// it may grow, but must not be cut while it is open.
    ///
    /// # Errors
    /// If it cannot be read, or does not even start as a recording; of a bag in
    /// SQLite, any damage.
    pub fn open(path: impl AsRef<Path>) -> Result<Self, RecordingError> {
        let path = path.as_ref();
        #[cfg(feature = "rosbag2")]
        if crate::is_bag(path) {
            return Recording::mapped(path, &crate::bag::as_recording(path)?);
        }
        let file = File::open(path).map_err(|source| unreadable(path, source))?;
        Recording::mapped(path, &file)
    }

    /// A file that errors call `path`.
    fn mapped(path: &Path, file: &File) -> Result<Self, RecordingError> {
        // SAFETY: the map is only read. Should another process write to the
        // file, bytes change under the reader, which checks each as if it came
        // from anywhere; should one cut it, the system ends this process.
        let map = unsafe { Mmap::map(file) }.map_err(|source| unreadable(path, source))?;
        Recording::new(path.to_owned(), Bytes::Mapped(map))
    }

    /// A recording in memory; errors call it `name`.
    ///
    /// # Errors
    /// If it does not even start as a recording.
    pub fn from_bytes(name: impl Into<PathBuf>, bytes: Vec<u8>) -> Result<Self, RecordingError> {
        Recording::new(name.into(), Bytes::Owned(bytes))
    }

    fn new(path: PathBuf, bytes: Bytes) -> Result<Self, RecordingError> {
        match Survey::of(bytes.as_slice()) {
            Ok(survey) => Ok(Recording {
                path,
                bytes,
                survey,
            }),
            Err(damage) => Err(RecordingError::Damaged {
                path,
                readable: 0,
                damage,
            }),
        }
    }

    /// The file.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Its size in bytes.
    #[must_use]
    pub fn size(&self) -> u64 {
        self.bytes().len() as u64
    }

    /// All channels, also those whose messages are only counted.
    pub fn channels(&self) -> impl Iterator<Item = &Channel> {
        self.survey.registry.channels()
    }

    /// The files in it.
    #[must_use]
    pub fn attachments(&self) -> &[AttachedFile] {
        &self.survey.extras.attachments
    }

    /// The bytes of one of its [`Recording::attachments`]; none of another's.
    #[must_use]
    pub fn content_of(&self, file: &AttachedFile) -> &[u8] {
        self.bytes().get(file.bytes.clone()).unwrap_or_default()
    }

    /// What is said of it as a whole.
    #[must_use]
    pub fn metadata(&self) -> &[MetadataRecord] {
        &self.survey.extras.metadata
    }

    /// How its messages are packed: the parts of the file that hold them.
    pub fn parts(&self) -> impl Iterator<Item = Part> {
        self.survey.blocks.iter().map(Block::part)
    }

    /// Readable messages of all channels.
    #[must_use]
    pub fn messages(&self) -> u64 {
        self.survey.messages
    }

    /// Log times of the first and the last readable message, nanoseconds since
    /// 1970.
    #[must_use]
    pub fn time_range_ns(&self) -> Option<(i64, i64)> {
        self.survey.time_range_ns()
    }

    /// What is wrong with the file, if anything.
    #[must_use]
    pub fn damage(&self) -> Option<&Damage> {
        self.survey.damage.as_ref()
    }

    /// All messages that are read, by log time, then the damage if there is any.
    #[must_use]
    pub fn records(&self) -> Records<'_> {
        self.records_of(&Kind::ALL)
    }

    /// As [`Recording::records`], but only those of some kinds.
    #[must_use]
    pub fn records_of(&self, kinds: &[Kind]) -> Records<'_> {
        Records::new(self, kinds, self.survey.damage.clone())
    }

    /// The messages of all channels as they stand in the file, by log time, then
    /// the damage if there is any.
    #[must_use]
    pub fn raw_records(&self) -> RawRecords<'_> {
        RawRecords::new(self, None, self.survey.damage.clone())
    }

    /// The channel that holds messages of a kind: the only one, or the one with
    /// the conventional name; `None` where there is none. Poses are taken under
    /// that name alone.
    ///
    /// # Errors
    /// If several could be meant.
    pub fn topic(&self, kind: Kind) -> Result<Option<Arc<str>>, RecordingError> {
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

    pub(crate) fn bytes(&self) -> &[u8] {
        self.bytes.as_slice()
    }
}

fn unreadable(path: &Path, source: std::io::Error) -> RecordingError {
    RecordingError::Open {
        path: path.to_owned(),
        source,
    }
}

impl Bytes {
    fn as_slice(&self) -> &[u8] {
        match self {
            Bytes::Mapped(map) => map,
            Bytes::Owned(bytes) => bytes,
        }
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
