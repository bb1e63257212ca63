//! Errors of this crate's commands, and their exit codes.

use std::path::PathBuf;

use command_line::{CommandError, FAILED, WRONG_USE};
use engine::EngineError;
use engine::heading::HeadingError;
use map::MapError;
use recording::RecordingError;

/// Why a scan of a recording cannot be searched.
#[derive(Debug, thiserror::Error)]
pub enum OfflineError {
    /// Prepared maps cannot be kept.
    #[error(transparent)]
    IndexCache(#[from] index_cache::CacheError),
    /// A message cannot be one of the graph.
    #[error(transparent)]
    Conversion(#[from] ros::ConversionError),
    /// A map file cannot be used.
    #[error(transparent)]
    Map(#[from] MapError),
    /// A recording cannot be used.
    #[error(transparent)]
    Recording(#[from] RecordingError),
    /// A scan whose heading is not known.
    #[error(transparent)]
    Heading(#[from] HeadingError),
    /// There is no map to search.
    #[error(
        "{} has no map on /map: name one with --map map.yaml",
        recording.display()
    )]
    NoMap {
        /// The recording.
        recording: PathBuf,
    },
    /// A map that is sound, but on which nothing can be found.
    #[error("{} cannot be searched", file.display())]
    UnusableMap {
        /// The map's file, or the recording that holds it.
        file: PathBuf,
        /// Why not.
        source: EngineError,
    },
    /// No map that counts for a scan can be used.
    #[error("{}: no map up to this scan can be searched: {reason}", file.display())]
    NoUsableMap {
        /// The recording that holds the maps.
        file: PathBuf,
        /// Why the last one cannot.
        reason: String,
    },
    /// No scan was accepted.
    #[error("{}: every scan was rejected, {scans} in all; the first: {reason}", file.display())]
    AllRefused {
        /// The recording.
        file: PathBuf,
        /// Scans that were taken.
        scans: u64,
        /// Why the first was.
        reason: String,
    },
    /// A recording by which nothing can be judged.
    #[error("{} has no true poses on /ground_truth: nothing to compare with", file.display())]
    NoTruths {
        /// The recording.
        file: PathBuf,
    },
    /// A recording whose true poses are of other scans than those taken.
    #[error(
        "{}: none of the {scans} scans taken has a true pose; the file holds {truths}, of other scans",
        file.display()
    )]
    NoTruthTaken {
        /// The recording.
        file: PathBuf,
        /// Scans that were taken.
        scans: u64,
        /// True poses in the recording.
        truths: usize,
    },
    /// A recording that has fewer scans than the number of the one asked for.
    #[error(
        "{}: there is no scan {wanted}; the scans taken are 1 to {found}",
        file.display()
    )]
    NoSuchScan {
        /// The recording.
        file: PathBuf,
        /// The number asked for, from 1.
        wanted: u64,
        /// Scans that are taken.
        found: u64,
    },
    /// A setting of the engine is out of range.
    #[error(transparent)]
    Setting(EngineError),
    /// A scan is refused.
    #[error(transparent)]
    Refused(EngineError),
    /// Options that do not go together.
    #[error("{0}")]
    Usage(String),
    /// The thread's processor time cannot be read.
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
