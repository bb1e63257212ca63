//! Adapts a map for the engine: geometry and suitability.

use engine::EngineError;
use engine::grid::{CellRules, Grid, GridFrame};
use map::OccupancyGrid;

/// Checks that a map can be searched, without preparing it.
/// Fails with errors of the engine: invalid sides, or no occupied or no free cell.
pub fn check_map(map: &OccupancyGrid, rules: CellRules) -> Result<(), EngineError> {
    let (width, height) = sides_of(map);
    Grid::new(width, height, &map.cells, rules)?.check_use()
}

pub fn frame_of(map: &OccupancyGrid) -> GridFrame {
    GridFrame::new(map.resolution_m, map.map_from_grid)
}

pub fn sides_of(map: &OccupancyGrid) -> (usize, usize) {
    (map.width as usize, map.height as usize)
}
