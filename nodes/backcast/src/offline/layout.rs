//! Where a map's cells lie, as the engine takes it.

use engine::grid::GridFrame;
use map::OccupancyGrid;

/// Size of a cell, and the pose of the lower left corner.
pub(crate) fn frame_of(map: &OccupancyGrid) -> GridFrame {
    GridFrame {
        resolution_m: map.resolution_m,
        map_from_grid: map.map_from_grid,
    }
}

/// Sides of a map, cells along x and y.
pub(crate) fn sides_of(map: &OccupancyGrid) -> (usize, usize) {
    (map.width as usize, map.height as usize)
}
