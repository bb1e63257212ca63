//! The occupancy grid.

use bytemuck::{Pod, Zeroable};
use iceoryx2_bb_derive_macros::ZeroCopySend;
use iceoryx2_bb_elementary_traits::zero_copy_send::ZeroCopySend;
use serde::{Deserialize, Serialize};

use crate::{Pose2, Stamp};

/// The occupancy of a cell about which nothing is known.
pub const UNKNOWN: u8 = 255;

/// Header of topic `map`; the items are `width · height` cells, row by row from
/// the lowest y: 0 free to 100 occupied, [`UNKNOWN`] unknown.
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable, ZeroCopySend, Serialize, Deserialize)]
#[type_name("MapHeader/v1")]
#[repr(C)]
pub struct MapHeader {
    /// When the map was read; the counter counts the maps served.
    pub stamp: Stamp,
    /// Hash of the cells and their geometry: equal maps have equal ids.
    pub map_id: u64,
    /// Cells along x.
    pub width: u32,
    /// Cells along y.
    pub height: u32,
    /// Side of a cell, metres.
    pub resolution_m: f64,
    /// The lower left corner of cell (0, 0) in the map frame, and the turn of
    /// the grid's axes.
    pub map_from_grid: Pose2,
}

#[cfg(test)]
mod tests {
    use super::*;
    crate::pin_layout!(MapHeader, size 72, align 8, {
        stamp: 0, map_id: 24, width: 32, height: 36, resolution_m: 40, map_from_grid: 48,
    });
}
