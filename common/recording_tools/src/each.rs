//! One file after another, of which one may be bad.

use std::path::{Path, PathBuf};

use progress::say;
use transport::with_causes;

use crate::RecordingToolsError;

/// Does something with each file; where there are several, one that fails is named on standard
/// error, and the others follow. Returns whether any failed.
///
/// # Errors
/// The only file failed, or standard output takes no more.
pub(crate) fn each(
    paths: &[PathBuf],
    mut act: impl FnMut(&Path) -> Result<(), RecordingToolsError>,
) -> Result<bool, RecordingToolsError> {
    let mut any_failed = false;
    for path in paths {
        match act(path) {
            Ok(()) => {}
            Err(error) if paths.len() == 1 || matches!(error, RecordingToolsError::Output(_)) => {
                return Err(error);
            }
            Err(error) => {
                say(&with_causes(&error));
                any_failed = true;
            }
        }
    }
    Ok(any_failed)
}
