//! Eight sums side by side, and eight times eight of them turned over.
//!
//! Written with the instructions that every x86-64 processor has: from plain
//! loops the compiler makes code that takes five times as long.

#[cfg(target_arch = "x86_64")]
use std::arch::x86_64::*;

/// Eight sums of neighbouring cells.
#[cfg(target_arch = "x86_64")]
#[derive(Clone, Copy)]
pub(super) struct Octet(__m128i);

#[cfg(target_arch = "x86_64")]
impl Octet {
    /// # Safety
    /// There must be eight bytes to read.
    #[inline(always)]
    pub(super) unsafe fn of_bytes(from: *const u8) -> Self {
        // SAFETY: promised by the caller.
        unsafe {
            let bytes = _mm_loadl_epi64(from.cast());
            Octet(_mm_unpacklo_epi8(bytes, _mm_setzero_si128()))
        }
    }

    /// # Safety
    /// There must be eight numbers to read.
    #[inline(always)]
    pub(super) unsafe fn of_words(from: *const u16) -> Self {
        // SAFETY: promised by the caller.
        unsafe { Octet(_mm_loadu_si128(from.cast())) }
    }

    /// The sums of both, where the mask is set.
    #[inline(always)]
    pub(super) fn plus(self, other: Octet, mask: &[u16; 8]) -> [u16; 8] {
        // SAFETY: arrays and vectors have the same size, and all bits mean a
        // number in both.
        unsafe {
            let mask = _mm_loadu_si128(mask.as_ptr().cast());
            let sums = _mm_and_si128(_mm_add_epi16(self.0, other.0), mask);
            std::mem::transmute::<__m128i, [u16; 8]>(sums)
        }
    }

    /// The square whose rows are the columns of this one.
    #[inline(always)]
    pub(super) fn turned(mut rows: [Octet; 8]) -> [Octet; 8] {
        // Three rounds that interleave rows i and i + 4 turn a square over.
        for _ in 0..3 {
            let before = rows;
            for i in 0..4 {
                let (a, b) = (before[i].0, before[i + 4].0);
                // SAFETY: these only move numbers between vectors.
                unsafe {
                    rows[2 * i] = Octet(_mm_unpacklo_epi16(a, b));
                    rows[2 * i + 1] = Octet(_mm_unpackhi_epi16(a, b));
                }
            }
        }
        rows
    }
}

/// Eight sums of neighbouring cells.
#[cfg(not(target_arch = "x86_64"))]
#[derive(Clone, Copy)]
pub(super) struct Octet([u16; 8]);

#[cfg(not(target_arch = "x86_64"))]
impl Octet {
    /// # Safety
    /// There must be eight bytes to read.
    #[inline(always)]
    pub(super) unsafe fn of_bytes(from: *const u8) -> Self {
        // SAFETY: promised by the caller.
        Octet(unsafe { *from.cast::<[u8; 8]>() }.map(u16::from))
    }

    /// # Safety
    /// There must be eight numbers to read.
    #[inline(always)]
    pub(super) unsafe fn of_words(from: *const u16) -> Self {
        // SAFETY: promised by the caller.
        Octet(unsafe { *from.cast() })
    }

    /// The sums of both, where the mask is set.
    #[inline(always)]
    pub(super) fn plus(self, other: Octet, mask: &[u16; 8]) -> [u16; 8] {
        std::array::from_fn(|i| (self.0[i] + other.0[i]) & mask[i])
    }

    /// The square whose rows are the columns of this one.
    #[inline(always)]
    pub(super) fn turned(rows: [Octet; 8]) -> [Octet; 8] {
        std::array::from_fn(|i| Octet(std::array::from_fn(|j| rows[j].0[i])))
    }
}

#[cfg(test)]
mod tests {
    use std::array;

    use super::*;

    #[test]
    fn rows_become_columns() {
        let bytes: [u8; 64] = array::from_fn(|i| i as u8);
        let words: [u16; 64] = array::from_fn(|i| 1000 * i as u16);
        // SAFETY: eight rows of eight are read of each.
        let (bytes, words) = unsafe {
            let row = |i: usize| Octet::of_bytes(bytes.as_ptr().add(8 * i));
            let bytes = Octet::turned(array::from_fn(row));
            let row = |i: usize| Octet::of_words(words.as_ptr().add(8 * i));
            (bytes, array::from_fn::<_, 8, _>(row))
        };
        let mask = array::from_fn(|j| if j == 3 { 0 } else { u16::MAX });
        for i in 0..8 {
            let expected = array::from_fn(|j| match j {
                3 => 0,
                _ => (8 * j + i + 1000 * (8 * i + j)) as u16,
            });
            assert_eq!(bytes[i].plus(words[i], &mask), expected);
        }
    }
}
