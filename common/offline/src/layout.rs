//! Adapts a map for the engine: geometry and suitability.

use engine::EngineError;
use engine::grid::{CellRules, Grid, GridFrame};
use map::OccupancyGrid;

/// Checks that a map can be searched, without preparing it.
/// Fails with errors of the engine: invalid sides, or no occupied or no free cell.
pub fn check_map(map: &OccupancyGrid, rules: CellRules) -> Result<(), EngineError> {
    let (width, height) = sides_of(map);
    let grid = Grid::new(width, height, &map.cells, rules)?;
    match (grid.occupied_cells(), grid.free_cells()) {
        (0, _) => Err(EngineError::NoOccupiedCell),
        (_, 0) => Err(EngineError::NoFreeCell),
        _ => Ok(()),
    }
}

pub fn frame_of(map: &OccupancyGrid) -> GridFrame {
    GridFrame {
        resolution_m: map.resolution_m,
        map_from_grid: map.map_from_grid,
    }
}

pub fn sides_of(map: &OccupancyGrid) -> (usize, usize) {
    (map.width as usize, map.height as usize)
}
