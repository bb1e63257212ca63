//! Unpacks the ends of the two intervals, direction by direction.

#[cfg(target_arch = "x86_64")]
use std::arch::x86_64::*;

#[cfg(target_arch = "x86_64")]
use bytemuck::{bytes_of, must_cast, pod_read_unaligned};

use super::{ALL, PACKED, STRETCHES};
#[cfg(target_arch = "x86_64")]
use crate::simd::{Avx2, avx2};

/// First and last bin of the near interval, then of the far one.
pub(super) type Ends<'a> = [&'a mut [u8]; 4];

/// Returns the last bin of the near interval.
#[inline(always)]
pub(crate) fn near_end(nearest: u8, farthest: u8, widths: u8) -> u8 {
    nearest.saturating_add(width(widths & 15)).min(farthest)
}

/// Returns the first bin of the far interval.
#[inline(always)]
pub(crate) fn far_start(nearest: u8, farthest: u8, widths: u8) -> u8 {
    farthest.saturating_sub(width(widths >> 4)).max(nearest)
}

/// Returns the width that a nibble stands for, in bins.
#[inline(always)]
pub(super) const fn width(nibble: u8) -> u8 {
    if nibble == ALL {
        return u8::MAX;
    }
    let (mut width, mut stretch) = (nibble, 0);
    while stretch < STRETCHES.len() {
        let (from, by) = STRETCHES[stretch];
        width += by * nibble.saturating_sub(from);
        stretch += 1;
    }
    width
}

/// Unpacks the intervals of a block: all rows have a byte for each direction.
pub(super) fn unpack([nearest, farthest, widths]: [&[u8]; PACKED], ends: Ends<'_>) {
    let [near_first, near_last, far_first, far_last] = ends;
    near_first.copy_from_slice(nearest);
    far_last.copy_from_slice(farthest);
    let packed = nearest.iter().zip(farthest).zip(widths);
    let inner = near_last.iter_mut().zip(far_first);
    for (((&nearest, &farthest), &widths), (near_last, far_first)) in packed.zip(inner) {
        *near_last = near_end(nearest, farthest, widths);
        *far_first = far_start(nearest, farthest, widths);
    }
}

/// Number of directions unpacked at a time.
#[cfg(target_arch = "x86_64")]
const LANES: usize = 32;

/// Widths that all nibbles stand for, twice.
#[cfg(target_arch = "x86_64")]
const WIDTHS: [u8; LANES] = {
    let mut widths = [0; LANES];
    let mut i = 0;
    while i < LANES {
        widths[i] = width(i as u8 % 16);
        i += 1;
    }
    widths
};

#[cfg(target_arch = "x86_64")]
avx2! {
    /// Does the same as [`unpack`], [`LANES`] directions at a time.
    pub(super) fn unpack_avx2(_set: Avx2, packed: [&[u8]; PACKED], ends: Ends<'_>) {
        let directions = packed[0].len();
        let Some(last) = directions.checked_sub(LANES) else {
            return unpack(packed, ends);
        };
        let [nearest, farthest, widths] = packed.map(|row| &row[..directions]);
        let mut ends = ends.map(|row| &mut row[..directions]);
        let (nibble, by_nibble) = (_mm256_set1_epi8(15), must_cast(WIDTHS));
        for start in (0..directions).step_by(LANES) {
            // If the directions are no multiple of the lanes, some are unpacked twice.
            let lanes = start.min(last)..start.min(last) + LANES;
            let read = |row: &[u8]| -> __m256i { pod_read_unaligned(&row[lanes.clone()]) };
            let (nearest, farthest, widths) = (read(nearest), read(farthest), read(widths));
            let near = _mm256_shuffle_epi8(by_nibble, _mm256_and_si256(widths, nibble));
            let far = _mm256_and_si256(_mm256_srli_epi16::<4>(widths), nibble);
            let far = _mm256_shuffle_epi8(by_nibble, far);
            let near_last = _mm256_min_epu8(_mm256_adds_epu8(nearest, near), farthest);
            let far_first = _mm256_max_epu8(_mm256_subs_epu8(farthest, far), nearest);
            for (row, unpacked) in ends.iter_mut().zip([nearest, near_last, far_first, farthest]) {
                row[lanes.clone()].copy_from_slice(bytes_of(&unpacked));
            }
        }
    }
}
