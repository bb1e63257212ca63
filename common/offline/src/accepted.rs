//! Counts accepted and rejected scans of a recording.

use std::path::Path;

use transport::with_causes;

use super::Reply;
use crate::OfflineError;

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
                .get_or_insert_with(|| with_causes(refusal));
        }
    }

    /// Fails if every scan was rejected.
    ///
    /// # Errors
    /// Every scan was rejected; names the first reason.
    pub fn check(self, file: &Path) -> Result<(), OfflineError> {
        match self.first_refusal {
            Some(reason) if self.refused == self.scans => Err(OfflineError::AllRefused {
                file: file.to_owned(),
                scans: self.scans,
                reason,
            }),
            _ => Ok(()),
        }
    }
}
