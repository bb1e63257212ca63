//! Asking for memory before it is needed.
//!
//! The index of a map is larger than any cache, and a search jumps about in it.

/// Bytes that come from memory at a time.
#[cfg(target_arch = "x86_64")]
const LINE: usize = 64;

/// Asks for bytes that are soon to be read.
#[inline]
pub(super) fn prefetch(bytes: &[u8]) {
    #[cfg(target_arch = "x86_64")]
    for line in bytes.chunks(LINE) {
        use std::arch::x86_64::{_MM_HINT_T0, _mm_prefetch};
        // SAFETY: every processor of this kind has the instruction, and it
        // changes nothing that a program can see.
        unsafe { _mm_prefetch::<_MM_HINT_T0>(line.as_ptr().cast()) };
    }
    #[cfg(not(target_arch = "x86_64"))]
    let _ = bytes;
}
