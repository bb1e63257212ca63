//! A map as the engine takes it: where its cells lie, and whether it can be used.

use engine::EngineError;
use engine::grid::{CellRules, Grid, GridFrame};
use map::OccupancyGrid;

/// Whether a map can be searched at all, without preparing it.
///
/// # Errors
/// As the engine would refuse it: its sides, or no occupied or no free cell.
pub fn check_map(map: &OccupancyGrid, rules: CellRules) -> Result<(), EngineError> {
    let (width, height) = sides_of(map);
    let grid = Grid::new(width, height, &map.cells, rules)?;
    match (grid.occupied_cells(), grid.free_cells()) {
        (0, _) => Err(EngineError::NoOccupiedCell),
        (_, 0) => Err(EngineError::NoFreeCell),
        _ => Ok(()),
    }
}

/// Size of a cell, and the pose of the lower left corner.
pub fn frame_of(map: &OccupancyGrid) -> GridFrame {
    GridFrame {
        resolution_m: map.resolution_m,
        map_from_grid: map.map_from_grid,
    }
}

/// Sides of a map, cells along x and y.
pub fn sides_of(map: &OccupancyGrid) -> (usize, usize) {
    (map.width as usize, map.height as usize)
}
