//! An error and what caused it, in words.

use std::error::Error;

/// An error and its causes, on one line.
///
/// Errors here say what their cause is by `source` alone and not in their own
/// words too, or it would be said twice. So whoever shows an error to people, in
/// a log or in health, shows it by this.
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::TransportError;

    #[test]
    fn causes_follow_the_error() {
        let error = TransportError::File {
            action: "list",
            path: "/some/where".into(),
            source: std::io::Error::other("the disk is gone"),
        };
        let text = with_causes(&error);
        assert_eq!(text, "cannot list /some/where: the disk is gone");
    }
}
