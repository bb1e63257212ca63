//! Errors in a descriptor.

use std::{fmt::Write as _, io, path::PathBuf};

use crate::{MAX_FILE_BYTES, Problem};

#[derive(Debug, thiserror::Error)]
pub enum DataflowError {
    #[error("cannot read {}", file.display())]
    Unreadable { file: PathBuf, source: io::Error },
    #[error("{} has more than {MAX_FILE_BYTES} bytes, which is the most that is read", file.display())]
    TooLarge { file: PathBuf },
    #[error("{}", lines(file, problems))]
    Wrong {
        file: PathBuf,
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
