//! One file of a recording.

use std::fs::File;
use std::path::{Path, PathBuf};

use memmap2::Mmap;

use crate::content::{Content, foreign, is_stream};
use crate::folder::Listed;
use crate::survey::Survey;
use crate::{Damage, RecordingError, unpack};

/// A file whose messages are known and whose checksums have been verified.
#[derive(Debug)]
pub(crate) struct RecordedFile {
    pub(crate) path: PathBuf,
    bytes: Bytes,
    pub(crate) survey: Survey,
}

#[derive(Debug)]
enum Bytes {
    Mapped(File, Mmap),
    Owned(Vec<u8>),
}

impl RecordedFile {
    /// Opens an MCAP file or an SQLite bag, also if it is compressed with zstd, and also from a pipe.
    pub(crate) fn open(listed: &Listed) -> Result<Self, RecordingError> {
        let path = &listed.path;
        if is_stream(path) {
            let saved = unpack::saved(path)?;
            return RecordedFile::at(listed, saved.path());
        }
        RecordedFile::at(listed, path)
    }

    /// Opens the file at `place`; errors call it by its listed name.
    fn at(listed: &Listed, place: &Path) -> Result<Self, RecordingError> {
        match Content::of(place)? {
            Content::Zstd => {
                let unpacked = unpack::file(place, |start| match Content::of_bytes(start) {
                    Content::Mcap | Content::Sqlite => Ok(()),
                    _ => Err(RecordingError::Unpack {
                        path: listed.path.clone(),
                        reason:
                            "what zstd packed there is neither an MCAP file nor a bag in SQLite"
                                .into(),
                    }),
                })?;
                RecordedFile::at(listed, unpacked.path())
            }
            Content::Foreign(what, advice) => Err(foreign(&listed.path, what, advice)),
            #[cfg(feature = "rosbag2")]
            Content::Sqlite => {
                let (file, damage) = crate::bag::as_recording(listed, place)?;
                let mut mapped = RecordedFile::mapped(&listed.path, &file)?;
                mapped.survey.damage = mapped.survey.damage.or(damage);
                Ok(mapped)
            }
            _ => {
                let file = File::open(place).map_err(RecordingError::open(&listed.path))?;
                RecordedFile::mapped(&listed.path, &file)
            }
        }
    }

    fn mapped(path: &Path, file: &File) -> Result<Self, RecordingError> {
        let file = file.try_clone().map_err(RecordingError::open(path))?;
        // SAFETY: the map is only read. If another process writes to the file, bytes change under
        // the reader, which checks each of them as untrusted input. If one truncates it, reading
        // behind its end would end this process: see `ensure_long`.
        let map = unsafe { Mmap::map(&file) }.map_err(RecordingError::open(path))?;
        RecordedFile::new(path.to_owned(), Bytes::Mapped(file, map))
    }

    /// Opens a file in memory; errors call it `path`.
    pub(crate) fn from_bytes(path: PathBuf, bytes: Vec<u8>) -> Result<Self, RecordingError> {
        RecordedFile::new(path, Bytes::Owned(bytes))
    }

    /// Stands for a file that does not even start as a recording.
    pub(crate) fn without_content(path: PathBuf, damage: Damage) -> Self {
        RecordedFile {
            path,
            bytes: Bytes::Owned(Vec::new()),
            survey: Survey {
                damage: Some(damage),
                ..Survey::default()
            },
        }
    }

    /// True for a file from [`RecordedFile::without_content`].
    pub(crate) fn is_without_content(&self) -> bool {
        self.bytes().is_empty()
    }

    fn new(path: PathBuf, bytes: Bytes) -> Result<Self, RecordingError> {
        match Survey::of(bytes.as_slice()) {
            Ok(survey) => Ok(RecordedFile {
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

    pub(crate) fn bytes(&self) -> &[u8] {
        self.bytes.as_slice()
    }

    /// Checks that the file still has its first `end` bytes, for the record that starts at byte
    /// `at`. Reading what another process has cut off would end this process (SIGBUS).
    pub(crate) fn ensure_long(&self, end: usize, at: usize) -> Result<(), Damage> {
        let Bytes::Mapped(file, _) = &self.bytes else {
            return Ok(());
        };
        let length = file.metadata().map_or(0, |found| found.len());
        if end as u64 <= length {
            return Ok(());
        }
        let at = at as u64;
        Err(Damage::Truncated { length, at })
    }
}

impl Bytes {
    fn as_slice(&self) -> &[u8] {
        match self {
            Bytes::Mapped(_, map) => map,
            Bytes::Owned(bytes) => bytes,
        }
    }
}
