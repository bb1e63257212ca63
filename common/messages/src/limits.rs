//! Limits on the size and origin of a map.

use std::f64::consts::TAU;

use geometry::Pose;

/// Largest number of cells along a side: columns and rows fit a signed 16-bit number, with room for
/// one step off the grid.
pub const MAX_SIDE: u32 = 32_767;

/// Largest number of cells: 20,000 squared, a square kilometre at 5 cm. Several processes hold the
/// map and tables of its size; this much still fits a large robot's computer, and a damaged header
/// that claims more is detected.
pub const MAX_CELLS: u64 = 400_000_000;

/// Smallest side of a cell in metres.
pub const MIN_RESOLUTION_M: f64 = 0.001;

/// Largest side of a cell in metres.
pub const MAX_RESOLUTION_M: f64 = 10.0;

/// Largest distance of the origin along each axis, in metres: covers map projections of the whole
/// Earth, and an `f64` still has a resolution of 15 nanometres there.
pub const MAX_ORIGIN_M: f64 = 1e8;

/// True if a map may have this many cells along x and y.
#[must_use]
pub fn size_is_allowed(width: u32, height: u32) -> bool {
    let sides = 1..=MAX_SIDE;
    sides.contains(&width)
        && sides.contains(&height)
        && u64::from(width) * u64::from(height) <= MAX_CELLS
}

/// True if a cell may have this side, in metres; false for NaN.
#[must_use]
pub fn resolution_is_allowed(metres: f64) -> bool {
    (MIN_RESOLUTION_M..=MAX_RESOLUTION_M).contains(&metres)
}

/// True if a grid may have this pose in the map frame; false for NaN and infinities.
#[must_use]
pub fn origin_is_allowed(origin: Pose) -> bool {
    origin.x.abs() <= MAX_ORIGIN_M && origin.y.abs() <= MAX_ORIGIN_M && origin.yaw.abs() <= TAU
}
