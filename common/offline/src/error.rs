//! Errors that several commands report in the same words.

use std::path::{Path, PathBuf};

use anyhow::anyhow;

/// None of the maps recorded up to a scan can be searched.
#[derive(Debug, thiserror::Error)]
#[error("{}: no map up to this scan can be searched: {reason}", file.display())]
pub struct NoUsableMap {
    pub(crate) file: PathBuf,
    /// Reason for the last map.
    pub(crate) reason: String,
}

pub fn no_truths(file: &Path) -> anyhow::Error {
    let file = file.display();
    anyhow!("{file} has no true poses on /ground_truth: nothing to compare with")
}

/// Error for a recording whose `truths` true poses do not belong to any of the `scans` searched.
pub fn no_truth_taken(file: &Path, scans: u64, truths: usize) -> anyhow::Error {
    let file = file.display();
    anyhow!(
        "{file}: none of the {scans} scans taken has a true pose; the file holds {truths}, of other scans; `evaluate --truth-gap-s` interpolates between them"
    )
}
