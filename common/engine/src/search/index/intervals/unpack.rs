//! Unpacks the ends of the two intervals, direction by direction.

use super::{ALL, PACKED, STRETCHES};
use crate::simd::{Kernel, Set};

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

/// Kernel that unpacks the intervals of a block: all rows have a byte for each direction.
pub(super) struct Unpacking<'a> {
    pub packed: [&'a [u8]; PACKED],
    /// First and last bin of the near interval, then of the far one.
    pub ends: [&'a mut [u8]; 4],
}

impl Kernel for Unpacking<'_> {
    type Result = ();

    #[inline(always)]
    fn run<S: Set>(self, _: S) {
        let directions = self.packed[0].len();
        let [nearest, farthest, widths] = self.packed.map(|row| &row[..directions]);
        let [near_first, near_last, far_first, far_last] =
            self.ends.map(|row| &mut row[..directions]);
        near_first.copy_from_slice(nearest);
        far_last.copy_from_slice(farthest);
        for i in 0..directions {
            near_last[i] = near_end(nearest[i], farthest[i], widths[i]);
            far_first[i] = far_start(nearest[i], farthest[i], widths[i]);
        }
    }
}
