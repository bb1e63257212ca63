//! Boundary cells of the obstacles.

use bytemuck::{Pod, Zeroable};
use serde::{Deserialize, Serialize};

use crate::Stamp;
#[cfg(feature = "iceoryx2")]
use crate::zero_copy::ZeroCopySend;

/// Header of topic `boundary`; the items are the boundary cells, sorted by (y, x).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Pod, Zeroable, Serialize, Deserialize)]
#[cfg_attr(
    feature = "iceoryx2",
    derive(ZeroCopySend),
    type_name("BoundaryHeader/v2")
)]
#[repr(C)]
pub struct BoundaryHeader {
    /// Stamp of the map.
    pub stamp: Stamp,
    /// Map of the boundary.
    pub map_id: u64,
    /// Number of free cells, the paper's n.
    pub free_cells: u64,
    /// Number of boundary cells, the paper's p.
    pub boundary_cells: u64,
    /// Number of occupied cells.
    pub occupied_cells: u64,
}

/// A boundary cell, given by its column and row.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Pod, Zeroable, Serialize, Deserialize)]
#[cfg_attr(
    feature = "iceoryx2",
    derive(ZeroCopySend),
    type_name("BoundaryCell/v1")
)]
#[repr(C)]
pub struct BoundaryCell {
    /// Column: cells along x from the grid's origin.
    pub x: u16,
    /// Row: cells along y from the grid's origin.
    pub y: u16,
}
