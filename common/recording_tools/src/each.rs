//! Reports on several recordings, some of which may be bad.

use std::path::{Path, PathBuf};

use command_line::{OutputError, say, stdout};
use offline::TopicOptions;
use recording::Recording;

/// Opens each recording with these topics, and prints the report on it. If there are several, an
/// error is printed to standard error and the next one follows. Returns true if any failed.
pub(crate) fn each(
    paths: &[PathBuf],
    topics: &TopicOptions,
    mut report: impl FnMut(&Path, Recording) -> anyhow::Result<String>,
) -> anyhow::Result<bool> {
    let mut act = |path: &PathBuf| {
        let mut recording = Recording::open(path)?;
        topics.apply(&mut recording)?;
        let text = report(path, recording)?;
        anyhow::Ok(stdout::print(&text)?)
    };
    let mut any_failed = false;
    for path in paths {
        match act(path) {
            Ok(()) => {}
            Err(error) if paths.len() == 1 || error.is::<OutputError>() => return Err(error),
            Err(error) => {
                say(&format!("{error:#}"));
                any_failed = true;
            }
        }
    }
    Ok(any_failed)
}
