//! Runs an action on several files, some of which may be bad.

use std::path::{Path, PathBuf};

use command_line::OutputError;
use progress::say;

/// Runs `act` on each file. If there are several, an error is printed to standard error and the
/// next file follows. Returns true if any failed.
///
/// # Errors
/// If the only file failed, or standard output is closed.
pub(crate) fn each(
    paths: &[PathBuf],
    mut act: impl FnMut(&Path) -> anyhow::Result<()>,
) -> anyhow::Result<bool> {
    let mut any_failed = false;
    for path in paths {
        match act(path) {
            Ok(()) => {}
            Err(error) if paths.len() == 1 || error.is::<OutputError>() => {
                return Err(error);
            }
            Err(error) => {
                say(&format!("{error:#}"));
                any_failed = true;
            }
        }
    }
    Ok(any_failed)
}
