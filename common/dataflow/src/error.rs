//! Errors in a descriptor.

use std::{fmt::Write as _, io, path::PathBuf};

use crate::{MAX_FILE_BYTES, Problem};

/// Error of a descriptor.
#[derive(Debug, thiserror::Error)]
pub enum DataflowError {
    /// The file could not be read.
    #[error("cannot read {}", file.display())]
    Unreadable {
        /// Path as given.
        file: PathBuf,
        source: io::Error,
    },
    /// The file is too large to be a descriptor.
    #[error("{} has more than {MAX_FILE_BYTES} bytes, which is the most that is read", file.display())]
    TooLarge {
        /// Path as given.
        file: PathBuf,
    },
    /// The file has errors.
    #[error("{}", lines(file, problems))]
    Wrong {
        /// Path as given.
        file: PathBuf,
        /// Problems in the order of the file, at least one.
        problems: Vec<Problem>,
    },
}

/// Formats a line for each problem: `file:line:column: what`.
fn lines(file: &std::path::Path, problems: &[Problem]) -> String {
    let mut text = String::new();
    for (i, problem) in problems.iter().enumerate() {
        let separator = if i == 0 { "" } else { "\n" };
        // Writing to a string cannot fail.
        let _ = write!(text, "{separator}{}:{problem}", file.display());
    }
    text
}
