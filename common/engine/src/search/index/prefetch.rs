//! Prefetching of memory before it is needed.
//!
//! The index of a map is larger than any cache, and a search jumps about in it.

/// Bytes of a cache line.
#[cfg(target_arch = "x86_64")]
const LINE: usize = 64;

/// Prefetches values that are soon to be read.
#[inline]
pub(in crate::search) fn prefetch<T>(values: &[T]) {
    #[cfg(target_arch = "x86_64")]
    for byte in (0..size_of_val(values)).step_by(LINE) {
        use std::arch::x86_64::{_MM_HINT_T0, _mm_prefetch};
        let line = values.as_ptr().cast::<i8>().wrapping_add(byte);
        // SAFETY: every processor of this kind has the instruction, and it
        // changes nothing that a program can see.
        unsafe { _mm_prefetch::<_MM_HINT_T0>(line) };
    }
    #[cfg(not(target_arch = "x86_64"))]
    let _ = values;
}
