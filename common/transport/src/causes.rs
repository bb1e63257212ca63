//! Formats an error with its causes.

use std::error::Error;

/// Returns an error and its causes on one line.
///
/// The messages of our errors do not include that of their `source`, so this must be used wherever
/// an error is shown to users, in a log or in health.
#[must_use]
pub fn with_causes(error: &dyn Error) -> String {
    let mut text = error.to_string();
    let mut cause = error.source();
    while let Some(error) = cause {
        text = format!("{text}: {error}");
        cause = error.source();
    }
    text
}
