//! Errors in a descriptor.

use std::io;
use std::path::{Path, PathBuf};

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
fn lines(file: &Path, problems: &[Problem]) -> String {
    let line = |problem| format!("{}:{problem}", file.display());
    let lines: Vec<String> = problems.iter().map(line).collect();
    lines.join("\n")
}
