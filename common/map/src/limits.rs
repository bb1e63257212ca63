//! How large a grid may be, and where it may lie.

use std::f64::consts::TAU;

use geometry::Pose;

/// Most cells along a side: a cell's column and row fit a signed 16-bit number,
/// with room to step off the grid by one.
pub const MAX_SIDE: u32 = 32_767;

/// Most cells: 20,000 squared, a square kilometre at 5 cm. Several processes keep
/// the map and tables as large as it; this much still fits a large robot's computer,
/// while a damaged header that claims more must not be believed.
pub const MAX_CELLS: u64 = 400_000_000;

/// Shortest side of a cell, metres.
pub const MIN_RESOLUTION_M: f64 = 0.001;

/// Longest side of a cell, metres.
pub const MAX_RESOLUTION_M: f64 = 10.0;

/// Farthest origin along each axis, metres: map projections of the whole Earth
/// stay within, and a nanometre is still resolved to a few hundredths.
pub const MAX_ORIGIN_M: f64 = 1e8;

/// Whether a grid may have these sides.
pub(crate) fn size_is_allowed(width: u32, height: u32) -> bool {
    let sides = 1..=MAX_SIDE;
    sides.contains(&width)
        && sides.contains(&height)
        && u64::from(width) * u64::from(height) <= MAX_CELLS
}

/// Whether a cell may have this side; false for NaN.
pub(crate) fn resolution_is_allowed(metres: f64) -> bool {
    (MIN_RESOLUTION_M..=MAX_RESOLUTION_M).contains(&metres)
}

/// Whether a grid may lie there; false for NaN and infinities.
pub(crate) fn origin_is_allowed(origin: Pose) -> bool {
    origin.x.abs() <= MAX_ORIGIN_M && origin.y.abs() <= MAX_ORIGIN_M && origin.yaw.abs() <= TAU
}
