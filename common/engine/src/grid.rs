//! The occupancy grid as rays see it: which cells are occupied and which block.
//!
//! A grid has its own frame: x along columns, y along rows, cell (0, 0) at the
//! origin. [`GridFrame`] says where that frame lies in the map.

mod cell_set;
mod frame;
mod pooling;

use crate::EngineError;
pub use messages::CellRules;

pub(crate) use cell_set::{CellSet, WORD};
pub use frame::GridFrame;
pub use pooling::{Pooled, pooling};

/// Most cells along a side: positions fit 15 bits, and no ray is longer than
/// what 16 bits hold.
pub const MAX_SIDE: usize = 32_767;

// What follows is limited as in map files, by crate `map`, which a test compares:
// no map that can be loaded is refused here.

/// Most cells; a damaged header that claims more must not be believed.
pub const MAX_CELLS: usize = 400_000_000;

/// Shortest side of a cell, metres.
pub const MIN_RESOLUTION_M: f64 = 0.001;

/// Longest side of a cell, metres.
pub const MAX_RESOLUTION_M: f64 = 10.0;

/// Farthest origin of a grid along each axis of the map, metres.
pub const MAX_ORIGIN_M: f64 = 1e8;

/// What a ray meets in a cell.
#[derive(Debug, Clone, Copy, PartialEq, Eq, bytemuck::NoUninit)]
#[repr(u8)]
pub enum Cell {
    /// Rays pass and the robot may stand here, as far as limits do not say otherwise:
    /// free, or unknown where unknown cells do not block.
    Open,
    /// An obstacle: a ray ends here.
    Occupied,
    /// Unknown cells block rays without a hit, and the robot cannot stand here.
    Blocked,
}

/// A grid of classed cells, row by row from the lowest y.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Grid {
    width: usize,
    height: usize,
    cells: Vec<Cell>,
    free: CellSet,
    free_cells: usize,
    occupied: usize,
    has_blocked: bool,
}

impl Grid {
    /// Classes `width · height` occupancies, row by row from the lowest y.
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
        // Whole maps are classed by looking up each cell, and counted class by class.
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
            has_blocked: count(Cell::Blocked) > 0,
            cells,
        })
    }

    /// Cells along x.
    #[must_use]
    pub fn width(&self) -> usize {
        self.width
    }

    /// Cells along y.
    #[must_use]
    pub fn height(&self) -> usize {
        self.height
    }

    /// All cells, row by row from the lowest y.
    #[must_use]
    pub fn cells(&self) -> &[Cell] {
        &self.cells
    }

    /// Column and row of each cell that is of a kind, row by row.
    pub(crate) fn places(&self, is: impl Fn(Cell) -> bool) -> impl Iterator<Item = (usize, usize)> {
        let cells = self.cells.iter().enumerate();
        let cells = cells.filter(move |&(_, &cell)| is(cell));
        cells.map(|(i, _)| (i % self.width, i / self.width))
    }

    /// Free cells, the paper's n; unknown ones do not count.
    #[must_use]
    pub fn free_cells(&self) -> usize {
        self.free_cells
    }

    /// The free cells.
    pub(crate) fn free(&self) -> &CellSet {
        &self.free
    }

    /// Whether an open cell is not known to be free.
    pub(crate) fn has_unknown(&self) -> bool {
        !self.has_blocked && self.free_cells + self.occupied < self.cells.len()
    }

    /// Occupied cells.
    #[must_use]
    pub fn occupied_cells(&self) -> usize {
        self.occupied
    }

    /// Whether any cell blocks rays without a hit.
    #[must_use]
    pub fn has_blocked(&self) -> bool {
        self.has_blocked
    }

    /// The cell at column `x` of row `y`; `None` off the grid.
    #[must_use]
    pub fn get(&self, x: i64, y: i64) -> Option<Cell> {
        let x = usize::try_from(x).ok().filter(|&x| x < self.width)?;
        let y = usize::try_from(y).ok().filter(|&y| y < self.height)?;
        Some(self.cells[y * self.width + x])
    }

    /// Whether the robot may stand in the cell; false off the grid.
    #[must_use]
    pub fn is_open(&self, x: i64, y: i64) -> bool {
        self.get(x, y) == Some(Cell::Open)
    }

    /// Whether one of the eight cells around it is open.
    #[must_use]
    pub fn touches_open(&self, x: i64, y: i64) -> bool {
        (-1..=1).any(|dy| (-1..=1).any(|dx| (dx, dy) != (0, 0) && self.is_open(x + dx, y + dy)))
    }
}

fn check_sides(width: usize, height: usize) -> Result<(), EngineError> {
    let in_range = 1..=MAX_SIDE;
    if !in_range.contains(&width) || !in_range.contains(&height) {
        return Err(EngineError::GridSides { width, height });
    }
    if width * height > MAX_CELLS {
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

/// NaN lies in no range.
pub(crate) fn check_resolution(metres: f64) -> Result<(), EngineError> {
    if (MIN_RESOLUTION_M..=MAX_RESOLUTION_M).contains(&metres) {
        return Ok(());
    }
    Err(EngineError::Resolution(metres))
}

/// Small worlds for tests: one line a row, highest y first, as one draws a map.
#[cfg(test)]
pub(crate) mod drawn {
    use messages::UNKNOWN;

    use super::*;

    /// `#` occupied, `.` free, `?` unknown.
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
        let error = Grid::new(0, 3, &[], rules).unwrap_err().to_string();
        assert_eq!(
            error,
            "a grid of 0 x 3 cells: each side must have 1 to 32767 cells"
        );
        let error = Grid::new(2, 3, &[0; 5], rules).unwrap_err().to_string();
        assert_eq!(
            error,
            "a grid of 2 x 3 cells came with 5 occupancies instead of 6"
        );
        assert!(Grid::new(MAX_SIDE + 1, 1, &vec![0; MAX_SIDE + 1], rules).is_err());
    }

    #[test]
    fn the_limits_are_those_of_map_files() {
        assert_eq!(MAX_SIDE, map::MAX_SIDE as usize);
        assert_eq!(MAX_CELLS as u64, map::MAX_CELLS);
        assert_eq!(MIN_RESOLUTION_M, map::MIN_RESOLUTION_M);
        assert_eq!(MAX_RESOLUTION_M, map::MAX_RESOLUTION_M);
        assert_eq!(MAX_ORIGIN_M, map::MAX_ORIGIN_M);
    }

    #[test]
    fn rows_run_upwards_from_the_lowest_y() {
        let grid = drawn::grid(&["#..", "..."]);
        assert_eq!(grid.get(0, 1), Some(Cell::Occupied));
        assert_eq!(grid.get(0, 0), Some(Cell::Open));
        assert_eq!(grid.get(0, 2), None);
        assert!(grid.touches_open(0, 1));
    }
}
