//! Full names of topics and services, as ROS 2 resolves them.

/// Returns the full name of `name` in `namespace`; a name that begins with a slash is full.
pub(crate) fn resolve(namespace: &str, name: &str) -> Result<String, String> {
    let whole = if name.starts_with('/') {
        name.to_owned()
    } else {
        format!("{}/{name}", namespace.trim_end_matches('/'))
    };
    let parts = whole
        .strip_prefix('/')
        .into_iter()
        .flat_map(|w| w.split('/'));
    let is_part = |part: &str| {
        let mut letters = part.bytes();
        let first = letters
            .next()
            .is_some_and(|b| b == b'_' || b.is_ascii_alphabetic());
        first && letters.all(|b| b == b'_' || b.is_ascii_alphanumeric())
    };
    if whole.starts_with('/') && parts.into_iter().all(is_part) {
        return Ok(whole);
    }
    Err(format!(
        "{whole:?} is not a name: allowed are parts of a-z A-Z 0-9 _ that begin with no digit, \
         each behind a slash"
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn relative_names_are_in_the_namespace() {
        assert_eq!(resolve("/", "scan").unwrap(), "/scan");
        assert_eq!(resolve("/r2", "scan").unwrap(), "/r2/scan");
        assert_eq!(resolve("/r2/", "front/scan").unwrap(), "/r2/front/scan");
        assert_eq!(resolve("/r2", "/tf").unwrap(), "/tf");
    }

    #[test]
    fn what_is_no_name_is_refused() {
        for (namespace, name) in [
            ("r2", "scan"),
            ("/", ""),
            ("/", "/"),
            ("/", "2d"),
            ("/", "a//b"),
            ("/", "a/"),
            ("/", "**"),
            ("/", "a%b"),
            ("/", "scän"),
        ] {
            assert!(resolve(namespace, name).is_err(), "{namespace} {name}");
        }
    }
}
