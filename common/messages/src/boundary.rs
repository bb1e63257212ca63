//! Boundary cells of the obstacles.

use crate::Stamp;

crate::message! {
    #[type_name("BoundaryHeader/v2")]
    /// Header of topic `boundary`; the items are the boundary cells, sorted by (y, x).
    #[derive(Eq)]
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

    #[type_name("BoundaryCell/v1")]
    /// A boundary cell, given by its column and row.
    #[derive(Eq, Hash)]
    pub struct BoundaryCell {
        /// Column: cells along x from the grid's origin.
        pub x: u16,
        /// Row: cells along y from the grid's origin.
        pub y: u16,
    }
}
