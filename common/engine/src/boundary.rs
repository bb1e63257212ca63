//! The boundary of the obstacles: the cells in which rays end.
//!
//! These are the paper's c_i ∈ C. All eight neighbours of a cell count, because rays step
//! diagonally: with four, a ray could end in a cell from which the reverse projection does not
//! start.

use messages::BoundaryCell;

use crate::grid::{Cell, Grid};

/// Returns the occupied cells with an open cell among their eight neighbours, by (y, x).
#[must_use]
pub fn extract(grid: &Grid) -> Vec<BoundaryCell> {
    let rows = grid.cells().chunks_exact(grid.width());
    rows.enumerate()
        .flat_map(|(y, row)| row.iter().enumerate().map(move |(x, &cell)| (x, y, cell)))
        .filter(|&(x, y, cell)| cell == Cell::Occupied && grid.touches_open(x as i64, y as i64))
        .map(|(x, y, _)| BoundaryCell {
            x: x as u16,
            y: y as u16,
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use messages::CellRules;
    use proptest::collection::vec;
    use proptest::prelude::*;

    use super::*;
    use crate::EngineError;
    use crate::grid::drawn::{grid, grid_with};
    use crate::reference;
    use crate::testing::{any_grid, space_of};

    fn drawn(cells: &[BoundaryCell], width: usize, height: usize) -> Vec<String> {
        let at = |x, y| {
            if cells.contains(&BoundaryCell { x, y }) {
                '*'
            } else {
                ' '
            }
        };
        (0..height as u16)
            .rev()
            .map(|y| (0..width as u16).map(|x| at(x, y)).collect())
            .collect()
    }

    #[test]
    fn takes_cells_that_touch_an_open_one_even_at_a_corner() {
        let grid = grid(&["......", ".####.", ".####.", ".####.", "......"]);
        let boundary = extract(&grid);
        assert_eq!(
            drawn(&boundary, 6, 5),
            ["      ", " **** ", " *  * ", " **** ", "      "]
        );
    }

    #[test]
    fn the_border_of_the_map_is_no_open_cell() {
        let boundary = extract(&grid(&["####", "####", "##.#"]));
        assert_eq!(drawn(&boundary, 4, 3), ["    ", " ***", " * *"]);
    }

    #[test]
    fn behind_blocking_unknown_cells_there_is_no_boundary() {
        let rows = ["??#..", "??#.."];
        assert_eq!(extract(&grid(&rows)).len(), 2);
        let rules = CellRules {
            unknown_blocks: true,
            ..CellRules::default()
        };
        assert_eq!(extract(&grid_with(&["#??", "?.#"], rules)).len(), 2);
        assert_eq!(extract(&grid_with(&["#??.", "#??."], rules)).len(), 0);
    }

    proptest! {
        #[test]
        fn rays_hit_the_cells_of_the_boundary_alone(
            grid in any_grid(), kept in vec(any::<bool>(), 64), heading in 0usize..16,
        ) {
            let all = extract(&grid);
            prop_assert_eq!(&grid.clone().with_boundary(&all, 1).unwrap(), &grid);
            let kept = |i: usize| kept[i % kept.len()];
            let some: Vec<_> = (0..all.len()).filter(|&i| kept(i)).map(|i| all[i]).collect();
            let with_some = grid.clone().with_boundary(&some, 1).unwrap();
            let space = space_of(&grid, 16);
            let direction = space.directions.get(heading);
            for (x, y) in grid.places(|cell| cell == Cell::Open) {
                let (x, y) = (x as i64, y as i64);
                let hit = reference::range(&grid, x, y, direction);
                let end = |steps| {
                    let (x, y) = (0..steps).fold((x, y), |(x, y), _| direction.advance(x, y));
                    BoundaryCell { x: x as u16, y: y as u16 }
                };
                let expected = hit.filter(|&steps| some.contains(&end(steps)));
                prop_assert_eq!(reference::range(&with_some, x, y, direction), expected);
            }
        }
    }

    #[test]
    fn a_cell_that_is_no_obstacle_is_refused() {
        let refused = |x, y| grid(&["#.", "##"]).with_boundary(&[BoundaryCell { x, y }], 1);
        assert!(refused(1, 0).is_ok());
        for (x, y) in [(1, 1), (2, 0), (0, 2)] {
            assert_eq!(refused(x, y), Err(EngineError::BoundaryCell { x, y }));
        }
    }

    #[test]
    fn the_order_is_by_row_then_column() {
        let boundary = extract(&grid(&["#.#", "...", "#.#"]));
        let order: Vec<_> = boundary.iter().map(|cell| (cell.y, cell.x)).collect();
        assert_eq!(order, [(0, 0), (0, 2), (2, 0), (2, 2)]);
    }
}
