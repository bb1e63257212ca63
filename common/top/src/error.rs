//! Errors of this crate's commands, and their exit codes.

use std::io;

use command_line::{CommandError, OutputError};

/// Error of `backcast top`.
#[derive(Debug, thiserror::Error)]
pub enum TopError {
    /// No monitor answers, or its answer is invalid.
    #[error("no monitor answers at {address}: is a graph running? ({reason})")]
    NoMonitor {
        /// Host and port.
        address: String,
        /// Description of the error.
        reason: String,
    },
    /// The monitor does not know the robot.
    #[error("the monitor at {address} knows no robot {robot:?}; it knows {}", known.join(", "))]
    NoRobot {
        /// Host and port.
        address: String,
        /// Robot as given.
        robot: String,
        /// Robots known by the monitor.
        known: Vec<String>,
    },
    /// The terminal cannot be used.
    #[error("cannot use the terminal")]
    Terminal(#[source] io::Error),
    /// Standard output cannot be written.
    #[error(transparent)]
    Output(#[from] OutputError),
}

impl CommandError for TopError {}
