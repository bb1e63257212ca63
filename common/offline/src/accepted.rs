//! Counts accepted and rejected scans of a recording.

use std::path::Path;

use anyhow::anyhow;

use super::Reply;

/// Number of scans searched and rejected, and the reason of the first rejection.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Accepted {
    scans: u64,
    refused: u64,
    first_refusal: Option<String>,
}

impl Accepted {
    pub fn count(&mut self, reply: &Reply<'_>) {
        self.scans += 1;
        if let Err(refusal) = &reply.answer {
            self.refused += 1;
            self.first_refusal
                .get_or_insert_with(|| format!("{refusal:#}"));
        }
    }

    /// Fails if every scan was rejected; names the first reason.
    pub fn check(self, file: &Path) -> anyhow::Result<()> {
        match self.first_refusal {
            Some(reason) if self.refused == self.scans => Err(anyhow!(
                "{}: every scan was rejected, {} in all; the first: {reason}",
                file.display(),
                self.scans
            )),
            _ => Ok(()),
        }
    }
}
