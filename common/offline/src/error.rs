//! Errors of this crate's commands, and their exit codes.

use std::path::PathBuf;

use command_line::{CommandError, FAILED, WRONG_USE};
use engine::EngineError;
use engine::heading::HeadingError;
use map::MapError;
use recording::RecordingError;

/// Errors of searching the scans of a recording.
#[derive(Debug, thiserror::Error)]
pub enum OfflineError {
    /// The index cache cannot be opened.
    #[error(transparent)]
    IndexCache(#[from] index_cache::CacheError),
    #[error(transparent)]
    Conversion(#[from] ros::ConversionError),
    #[error(transparent)]
    Map(#[from] MapError),
    #[error(transparent)]
    Recording(#[from] RecordingError),
    /// The heading of a scan is not known.
    #[error(transparent)]
    Heading(#[from] HeadingError),
    #[error(
        "{} has no map on /map: name one with --map map.yaml",
        recording.display()
    )]
    NoMap { recording: PathBuf },
    /// The map can be read, but not searched.
    #[error("{} cannot be searched", file.display())]
    UnusableMap {
        /// The map's file, or the recording that contains it.
        file: PathBuf,
        source: EngineError,
    },
    /// None of the maps recorded up to a scan can be searched.
    #[error("{}: no map up to this scan can be searched: {reason}", file.display())]
    NoUsableMap {
        file: PathBuf,
        /// Reason for the last map.
        reason: String,
    },
    #[error("{}: every scan was rejected, {scans} in all; the first: {reason}", file.display())]
    AllRefused {
        file: PathBuf,
        scans: u64,
        reason: String,
    },
    #[error("{} has no true poses on /ground_truth: nothing to compare with", file.display())]
    NoTruths { file: PathBuf },
    /// The true poses of a recording belong to other scans.
    #[error(
        "{}: none of the {scans} scans taken has a true pose; the file holds {truths}, of other scans",
        file.display()
    )]
    NoTruthTaken {
        file: PathBuf,
        /// Number of scans searched.
        scans: u64,
        truths: usize,
    },
    #[error(
        "{}: there is no scan {wanted}; the scans taken are 1 to {found}",
        file.display()
    )]
    NoSuchScan {
        file: PathBuf,
        /// Number of the scan, counted from 1.
        wanted: u64,
        /// Number of scans.
        found: u64,
    },
    #[error(transparent)]
    Setting(EngineError),
    #[error(transparent)]
    Refused(EngineError),
    #[error("{0}")]
    Usage(String),
    #[error("cannot read the processor time of a thread")]
    Clock(#[source] nix::Error),
}

impl CommandError for OfflineError {
    fn exit_code(&self) -> u8 {
        match self {
            Self::Usage(_) | Self::Setting(_) => WRONG_USE,
            _ => FAILED,
        }
    }
}
