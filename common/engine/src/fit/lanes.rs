//! Groups of eight beam ends. Numbers have 32 bits, which is 1/256 of a cell on the largest map;
//! sums are per lane, so that every instruction set gives the same ones.

/// Number of ends in a group.
pub(super) const LANES: usize = 8;

pub(super) type Lanes = [f32; LANES];

/// Computes one value for each lane.
#[inline(always)]
pub(super) fn lanes<T>(of: impl FnMut(usize) -> T) -> [T; LANES] {
    std::array::from_fn(of)
}

/// Ends of beams in the target frame, in cells; unused lanes have weight 0.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct EndLanes {
    pub x: Lanes,
    pub y: Lanes,
    pub weight: Lanes,
}
