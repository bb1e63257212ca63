//! Checks that shared memory has room before it is written, as a touch without a free page kills
//! the process with SIGBUS.

use std::path::Path;

use nix::sys::statvfs::statvfs;

use crate::TransportError;
use crate::membership::SHARED_MEMORY;

/// Bytes that stay free in addition to the sample, for allocations of iceoryx2 itself.
pub(crate) const RESERVE: u64 = 1 << 20;

pub(crate) fn ensure_free(topic: &'static str, needed: u64) -> Result<(), TransportError> {
    decide(topic, needed, free_bytes(Path::new(SHARED_MEMORY))?)
}

/// True if there is room for a small sample; without it, no node can send a heartbeat.
pub fn shared_memory_has_room() -> bool {
    ensure_free("", 0).is_ok()
}

fn decide(topic: &'static str, needed: u64, free: u64) -> Result<(), TransportError> {
    let needed = needed.saturating_add(RESERVE);
    if needed <= free {
        return Ok(());
    }
    Err(TransportError::SharedMemoryFull {
        topic,
        needed,
        free,
        path: SHARED_MEMORY.into(),
    })
}

fn free_bytes(path: &Path) -> Result<u64, TransportError> {
    let found = statvfs(path).map_err(|errno| TransportError::File {
        action: "ask for the free space of",
        path: path.to_owned(),
        source: errno.into(),
    })?;
    Ok(found
        .blocks_available()
        .saturating_mul(found.fragment_size()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn refuses_what_does_not_fit_and_says_both_numbers() {
        assert!(decide("map", 1000, RESERVE + 1000).is_ok());
        let error = decide("map", 1000, RESERVE + 999).unwrap_err();
        let text = error.to_string();
        assert!(text.contains("topic map"), "{text}");
        assert!(text.contains(&(RESERVE + 1000).to_string()), "{text}");
        assert!(text.contains(&(RESERVE + 999).to_string()), "{text}");
        assert!(decide("map", u64::MAX, u64::MAX - 1).is_err());
    }
}
