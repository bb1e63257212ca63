//! Eight ends of beams side by side. Numbers have 32 bits, which is 1/256 of a cell on the
//! largest map; sums go lane by lane, so that every instruction set gives the same ones.

/// Ends at a time.
pub(super) const LANES: usize = 8;

pub(super) type Lanes = [f32; LANES];

/// One number for each lane.
#[inline(always)]
pub(super) fn lanes<T>(of: impl FnMut(usize) -> T) -> [T; LANES] {
    std::array::from_fn(of)
}

/// Ends of beams as seen from the target frame, cells; lanes that are left have no weight.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct EndLanes {
    pub x: Lanes,
    pub y: Lanes,
    pub weight: Lanes,
}
