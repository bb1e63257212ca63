//! The occupancy grid as rays see it: which cells are occupied and which block rays.
//!
//! A grid has its own frame: x along columns, y along rows, cell (0, 0) at the origin.
//! [`GridFrame`] is the pose of that frame in the map.

mod cell_set;
mod frame;
mod pooling;

use messages::BoundaryCell;
use messages::limits::{MAX_CELLS, MAX_SIDE, resolution_is_allowed};

use crate::EngineError;
pub use messages::CellRules;

pub(crate) use cell_set::{CellSet, WORD, ones};
pub use frame::GridFrame;
pub use pooling::{Pooled, pooling};

/// Class of a cell, by its effect on rays.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, bytemuck::NoUninit)]
#[repr(u8)]
pub enum Cell {
    /// Rays pass, and the robot may stand here unless limits exclude it: a free cell, or an unknown
    /// one if unknown cells do not block.
    Open,
    /// An obstacle: a ray ends here.
    Occupied,
    /// Rays end here without a hit, and the robot cannot stand here: an unknown cell if these block,
    /// or an obstacle that is missing from the boundary.
    #[default]
    Blocked,
}

/// A grid of classified cells, row by row from the lowest y.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Grid {
    width: usize,
    height: usize,
    cells: Vec<Cell>,
    free: CellSet,
    free_cells: usize,
    occupied: usize,
    blocked: usize,
}

impl Grid {
    /// Classifies `width · height` occupancies, row by row from the lowest y.
    ///
    /// # Errors
    /// If a side is 0 or above [`MAX_SIDE`], or the number of cells is above
    /// [`MAX_CELLS`] or not `width · height`.
    pub fn new(
        width: usize,
        height: usize,
        occupancy: &[u8],
        rules: CellRules,
    ) -> Result<Self, EngineError> {
        check_cells(width, height, occupancy)?;
        let class = |occupancy: u8| match () {
            () if rules.is_occupied(occupancy) => Cell::Occupied,
            () if rules.unknown_blocks && !rules.is_free(occupancy) => Cell::Blocked,
            () => Cell::Open,
        };
        // A table of all 256 values and one count per class are fastest on whole maps.
        let classes: [Cell; 1 << u8::BITS] =
            std::array::from_fn(|occupancy| class(occupancy as u8));
        let cells: Vec<Cell> = occupancy
            .iter()
            .map(|&value| classes[usize::from(value)])
            .collect();
        let count = |kind| cells.iter().filter(|&&cell| cell == kind).count();
        let free = CellSet::of_bytes(occupancy, |cell| rules.is_free(cell));
        Ok(Grid {
            width,
            height,
            free_cells: free.count(),
            free,
            occupied: count(Cell::Occupied),
            blocked: count(Cell::Blocked),
            cells,
        })
    }

    /// Takes the cells in which rays end with a hit from a boundary, given in cells of which
    /// `pooling` lie along the side of one of these. Any other occupied cell that touches an open one
    /// blocks rays without a hit; those behind stay obstacles, as no ray reaches them. With all cells
    /// of [`boundary::extract`](crate::boundary::extract) the grid stays equal.
    ///
    /// # Errors
    /// If a cell is not an occupied cell of the grid.
    pub fn with_boundary(
        mut self,
        boundary: &[BoundaryCell],
        pooling: usize,
    ) -> Result<Self, EngineError> {
        let mut hit = CellSet::none(self.cells.len());
        for &BoundaryCell { x, y } in boundary {
            let (column, row) = (usize::from(x) / pooling, usize::from(y) / pooling);
            if self.get(column as i64, row as i64) != Some(Cell::Occupied) {
                return Err(EngineError::BoundaryCell { x, y });
            }
            hit.insert(row * self.width + column);
        }
        let is_missing = |&(x, y): &(usize, usize)| {
            !hit.holds(y * self.width + x) && self.touches_open(x as i64, y as i64)
        };
        let missing: Vec<_> = self
            .places(|cell| cell == Cell::Occupied)
            .filter(is_missing)
            .collect();
        for &(x, y) in &missing {
            self.cells[y * self.width + x] = Cell::Blocked;
        }
        self.occupied -= missing.len();
        self.blocked += missing.len();
        Ok(self)
    }

    /// Number of cells along x.
    pub fn width(&self) -> usize {
        self.width
    }

    /// Number of cells along y.
    pub fn height(&self) -> usize {
        self.height
    }

    /// All cells, row by row from the lowest y.
    pub fn cells(&self) -> &[Cell] {
        &self.cells
    }

    /// Returns column and row of each cell for which `is` returns true, row by row.
    pub(crate) fn places(&self, is: impl Fn(Cell) -> bool) -> impl Iterator<Item = (usize, usize)> {
        let cells = self.cells.iter().enumerate();
        let cells = cells.filter(move |&(_, &cell)| is(cell));
        cells.map(|(i, _)| (i % self.width, i / self.width))
    }

    /// Checks that a scan can be matched with the grid, and that there is room for the robot.
    ///
    /// # Errors
    /// If no cell is occupied, or none is free.
    pub fn check_use(&self) -> Result<(), EngineError> {
        match (self.occupied, self.free_cells) {
            (0, _) => Err(EngineError::NoOccupiedCell),
            (_, 0) => Err(EngineError::NoFreeCell),
            _ => Ok(()),
        }
    }

    /// Number of free cells, the paper's n; unknown ones do not count.
    pub fn free_cells(&self) -> usize {
        self.free_cells
    }

    pub(crate) fn free(&self) -> &CellSet {
        &self.free
    }

    /// True if some open cell is unknown rather than free.
    pub(crate) fn has_unknown(&self) -> bool {
        self.free_cells + self.occupied + self.blocked < self.cells.len()
    }

    /// Number of occupied cells.
    pub fn occupied_cells(&self) -> usize {
        self.occupied
    }

    /// True if any cell blocks rays without a hit.
    pub fn has_blocked(&self) -> bool {
        self.blocked > 0
    }

    /// Returns the cell at column `x` of row `y`; `None` off the grid.
    #[must_use]
    pub fn get(&self, x: i64, y: i64) -> Option<Cell> {
        let x = usize::try_from(x).ok().filter(|&x| x < self.width)?;
        let y = usize::try_from(y).ok().filter(|&y| y < self.height)?;
        Some(self.cells[y * self.width + x])
    }

    /// True if the robot may stand in the cell; false off the grid.
    #[must_use]
    pub fn is_open(&self, x: i64, y: i64) -> bool {
        self.get(x, y) == Some(Cell::Open)
    }

    /// True if one of the eight cells around it is open.
    #[must_use]
    pub fn touches_open(&self, x: i64, y: i64) -> bool {
        (-1..=1).any(|dy| (-1..=1).any(|dx| (dx, dy) != (0, 0) && self.is_open(x + dx, y + dy)))
    }
}

fn check_sides(width: usize, height: usize) -> Result<(), EngineError> {
    let in_range = 1..=MAX_SIDE as usize;
    if !in_range.contains(&width) || !in_range.contains(&height) {
        return Err(EngineError::GridSides { width, height });
    }
    if (width * height) as u64 > MAX_CELLS {
        return Err(EngineError::GridSize { width, height });
    }
    Ok(())
}

fn check_cells(width: usize, height: usize, occupancy: &[u8]) -> Result<(), EngineError> {
    check_sides(width, height)?;
    let cells = occupancy.len();
    if cells != width * height {
        return Err(EngineError::GridCells {
            width,
            height,
            cells,
        });
    }
    Ok(())
}

/// Checks the side of a cell; NaN is out of range.
pub(crate) fn check_resolution(metres: f64) -> Result<(), EngineError> {
    match resolution_is_allowed(metres) {
        true => Ok(()),
        false => Err(EngineError::Resolution(metres)),
    }
}

/// Small worlds for tests, drawn as text: one line per row, highest y first.
#[cfg(test)]
pub(crate) mod drawn {
    use messages::UNKNOWN;

    use super::*;

    /// Reads a drawing: `#` occupied, `.` free, `?` unknown.
    pub(crate) fn occupancy(rows: &[&str]) -> (usize, usize, Vec<u8>) {
        let width = rows[0].len();
        let cells = rows.iter().rev().flat_map(|row| {
            assert_eq!(row.len(), width, "rows of one length");
            row.bytes().map(|c| match c {
                b'#' => 100,
                b'.' => 0,
                b'?' => UNKNOWN,
                other => panic!("no such cell: {}", other as char),
            })
        });
        (width, rows.len(), cells.collect())
    }

    pub(crate) fn grid(rows: &[&str]) -> Grid {
        grid_with(rows, CellRules::default())
    }

    pub(crate) fn grid_with(rows: &[&str], rules: CellRules) -> Grid {
        let (width, height, cells) = occupancy(rows);
        Grid::new(width, height, &cells, rules).expect("a drawn grid is sound")
    }
}

#[cfg(test)]
mod tests {
    use messages::UNKNOWN;

    use super::*;

    #[test]
    fn classes_cells_by_the_rules() {
        let cells = [0, 25, 26, 64, 65, 100, UNKNOWN];
        let open = Grid::new(7, 1, &cells, CellRules::default()).unwrap();
        use Cell::{Blocked, Occupied, Open};
        assert_eq!(
            open.cells(),
            [Open, Open, Open, Open, Occupied, Occupied, Open]
        );
        assert_eq!((open.free_cells(), open.occupied_cells()), (2, 2));
        let rules = CellRules {
            unknown_blocks: true,
            ..CellRules::default()
        };
        let blocked = Grid::new(7, 1, &cells, rules).unwrap();
        assert_eq!(
            blocked.cells(),
            [Open, Open, Blocked, Blocked, Occupied, Occupied, Blocked]
        );
    }

    #[test]
    fn refuses_sides_and_counts_that_cannot_be() {
        let rules = CellRules::default();
        let (width, height, cells) = (0, 3, 5);
        let refused = Grid::new(width, height, &[], rules);
        assert_eq!(refused, Err(EngineError::GridSides { width, height }));
        let width = 2;
        let refused = Grid::new(width, height, &[0; 5], rules);
        let expected = EngineError::GridCells {
            width,
            height,
            cells,
        };
        assert_eq!(refused, Err(expected));
        let width = MAX_SIDE as usize + 1;
        assert!(Grid::new(width, 1, &vec![0; width], rules).is_err());
    }
}
