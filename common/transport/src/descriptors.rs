//! Whether the process may open as many files as a member needs, asked before it joins.

use nix::sys::resource::{Resource, getrlimit, setrlimit};

use crate::TransportError;

/// What a member may need: an end of a topic opens a few files for each of its partners.
const NEEDED: u64 = 512;

/// Raises the limit of this process as far as that is needed.
///
/// # Errors
/// [`TransportError::Descriptors`] if the hard limit is lower.
pub(crate) fn ensure() -> Result<(), TransportError> {
    let Ok((soft, hard)) = getrlimit(Resource::RLIMIT_NOFILE) else {
        // Where it cannot be asked it shows when it is reached.
        return Ok(());
    };
    if decide(soft, hard)? {
        // A limit that cannot be raised shows when it is reached, too.
        let _ = setrlimit(Resource::RLIMIT_NOFILE, NEEDED, hard);
    }
    Ok(())
}

/// Whether the limit is to be raised.
fn decide(soft: u64, hard: u64) -> Result<bool, TransportError> {
    match hard < NEEDED {
        true => Err(TransportError::Descriptors {
            found: hard,
            needed: NEEDED,
        }),
        false => Ok(soft < NEEDED),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_low_limit_is_raised_and_one_that_cannot_be_is_refused() {
        assert!(!decide(1024, 4096).unwrap());
        assert!(decide(100, 4096).unwrap());
        let error = decide(100, 100).unwrap_err().to_string();
        assert!(error.contains("100") && error.contains("512"), "{error}");
        assert!(error.contains("ulimit -n"), "{error}");
    }
}
