//! Errors of this crate's commands, and their exit codes.

use std::{io, path::PathBuf};

use benchmarks::BenchmarksError;
use command_line::{CommandError, FAILED, OutputError};
use drawing::DrawingError;
use engine::heading::HeadingError;
use map::MapError;
use offline::OfflineError;
use plots::PlotError;
use recording::RecordingError;
use simulation::SimulationError;

/// Why nothing can be measured.
#[derive(Debug, thiserror::Error)]
pub enum BenchError {
    /// A case of the bench cannot be set up.
    #[error(transparent)]
    Benchmarks(#[from] BenchmarksError),
    /// A drive cannot be simulated.
    #[error(transparent)]
    Simulation(#[from] SimulationError),
    /// A scan cannot be searched.
    #[error(transparent)]
    Offline(#[from] OfflineError),
    /// A picture cannot be made.
    #[error(transparent)]
    Plot(#[from] PlotError),
    /// A picture cannot be made.
    #[error(transparent)]
    Drawing(#[from] DrawingError),
    /// A map file cannot be used.
    #[error(transparent)]
    Map(#[from] MapError),
    /// A recording cannot be used.
    #[error(transparent)]
    Recording(#[from] RecordingError),
    /// A folder cannot be made, or not be written into.
    #[error("cannot write into the folder {}", folder.display())]
    OutFolder {
        /// As it was given.
        folder: PathBuf,
        /// Why not.
        source: io::Error,
    },
    /// A table cannot be stored.
    #[error("cannot write the table {}", file.display())]
    Table {
        /// Its file.
        file: PathBuf,
        /// Why not.
        source: io::Error,
    },
    /// Standard output takes no more.
    #[error(transparent)]
    Output(#[from] OutputError),
    /// A scan whose heading is not known.
    #[error(transparent)]
    Heading(#[from] HeadingError),
}

impl CommandError for BenchError {
    fn exit_code(&self) -> u8 {
        match self {
            Self::Offline(error) => error.exit_code(),
            Self::Plot(error) => error.exit_code(),
            _ => FAILED,
        }
    }
}
