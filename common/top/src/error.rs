//! Errors of this crate's commands, and their exit codes.

use std::io;

use command_line::{CommandError, OutputError};

/// Why a graph cannot be shown.
#[derive(Debug, thiserror::Error)]
pub enum TopError {
    /// A monitor does not answer, or not as one does.
    #[error("no monitor answers at {address}: is a graph running? ({reason})")]
    NoMonitor {
        /// Host and port.
        address: String,
        /// What went wrong.
        reason: String,
    },
    /// The monitor does not know the robot.
    #[error("the monitor at {address} knows no robot {robot:?}; it knows {}", known.join(", "))]
    NoRobot {
        /// Host and port.
        address: String,
        /// As it was given.
        robot: String,
        /// The robots that it knows.
        known: Vec<String>,
    },
    /// The terminal cannot be used.
    #[error("cannot use the terminal")]
    Terminal(#[source] io::Error),
    /// Standard output takes no more.
    #[error(transparent)]
    Output(#[from] OutputError),
}

impl CommandError for TopError {}
