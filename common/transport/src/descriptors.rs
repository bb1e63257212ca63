//! Checks, before a process joins, that it may open as many files as a member needs.

use nix::sys::resource::{Resource, getrlimit, setrlimit};

use crate::TransportError;

/// Number of files that a member may need: each port opens a few files for each of its peers.
const NEEDED: u64 = 512;

/// Raises the soft limit of this process to [`NEEDED`] if it is lower.
pub(crate) fn ensure() -> Result<(), TransportError> {
    let Ok((soft, hard)) = getrlimit(Resource::RLIMIT_NOFILE) else {
        // An unknown limit shows when it is reached.
        return Ok(());
    };
    if decide(soft, hard)? {
        // So does a limit that cannot be raised.
        let _ = setrlimit(Resource::RLIMIT_NOFILE, NEEDED, hard);
    }
    Ok(())
}

/// Returns true if the soft limit must be raised.
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
