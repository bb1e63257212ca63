//! The occupancy grid as rays see it: which cells are occupied and which block.
//!
//! A grid has its own frame: x along columns, y along rows, cell (0, 0) at the
//! origin. [`GridFrame`] says where that frame lies in the map.

use geometry::Pose;
use messages::UNKNOWN;

use crate::EngineError;

/// Most cells along a side: positions fit 15 bits, and no ray is longer than
/// what 16 bits hold.
pub const MAX_SIDE: usize = 32_767;

/// Rules by which the occupancy of a cell, 0..=100 or unknown, is read.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::Args)]
pub struct CellRules {
    /// Occupancy from which a cell is occupied, per cent, 1..=100; the default
    /// is that of map savers.
    #[arg(long, value_name = "PERCENT", default_value_t = 65, value_parser = clap::value_parser!(u8).range(1..=100))]
    pub occupied_from: u8,
    /// Occupancy up to which a cell is free, per cent, 0..=99; what lies
    /// between counts as unknown.
    #[arg(long, value_name = "PERCENT", default_value_t = 25, value_parser = clap::value_parser!(u8).range(0..=99))]
    pub free_to: u8,
    /// Unknown cells block rays and cannot hold the robot. Real maps are half
    /// known, so by default they neither block nor are ruled out.
    #[arg(long)]
    pub unknown_blocks: bool,
}

impl Default for CellRules {
    fn default() -> Self {
        CellRules {
            occupied_from: 65,
            free_to: 25,
            unknown_blocks: false,
        }
    }
}

/// Where a grid lies in the map frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GridFrame {
    /// Side of a cell, metres.
    pub resolution_m: f64,
    /// The lower left corner of cell (0, 0), and the turn of the grid's axes.
    pub map_from_grid: Pose,
}

impl GridFrame {
    /// The pose in the map of a position in cells and a heading in the grid's
    /// frame, radians. The centre of cell (0, 0) is (0.5, 0.5).
    #[must_use]
    pub fn map_from_cells(&self, x: f64, y: f64, heading: f64) -> Pose {
        self.map_from_grid.then(Pose::new(
            x * self.resolution_m,
            y * self.resolution_m,
            heading,
        ))
    }

    /// The inverse of [`GridFrame::map_from_cells`]: x and y in cells, and the
    /// heading in the grid's frame.
    #[must_use]
    pub fn cells_from_map(&self, map_pose: Pose) -> (f64, f64, f64) {
        let grid_pose = self.map_from_grid.inverse().then(map_pose);
        (
            grid_pose.x / self.resolution_m,
            grid_pose.y / self.resolution_m,
            grid_pose.yaw,
        )
    }
}

/// What a ray meets in a cell.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Cell {
    /// Rays pass and the robot may stand here: free, or unknown where unknown
    /// cells do not block.
    Open,
    /// An obstacle: a ray ends here.
    Occupied,
    /// Rays are lost here without a hit, and the robot cannot stand here.
    Blocked,
}

/// A grid of classed cells, row by row from the lowest y.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Grid {
    width: usize,
    height: usize,
    cells: Vec<Cell>,
    free: usize,
    occupied: usize,
}

impl Grid {
    /// Classes `width · height` occupancies, row by row from the lowest y.
    ///
    /// # Errors
    /// If a side is 0 or above [`MAX_SIDE`], or the number of cells is not
    /// `width · height`.
    pub fn new(
        width: usize,
        height: usize,
        occupancy: &[u8],
        rules: CellRules,
    ) -> Result<Self, EngineError> {
        let in_range = 1..=MAX_SIDE;
        if !in_range.contains(&width) || !in_range.contains(&height) {
            return Err(EngineError::GridSides { width, height });
        }
        if occupancy.len() != width * height {
            return Err(EngineError::GridCells {
                width,
                height,
                cells: occupancy.len(),
            });
        }
        let mut grid = Grid {
            width,
            height,
            cells: Vec::with_capacity(occupancy.len()),
            free: 0,
            occupied: 0,
        };
        for &value in occupancy {
            let is_occupied = value >= rules.occupied_from && value != UNKNOWN;
            let is_free = value <= rules.free_to && !is_occupied;
            grid.occupied += usize::from(is_occupied);
            grid.free += usize::from(is_free);
            grid.cells.push(match (is_occupied, is_free) {
                (true, _) => Cell::Occupied,
                (false, false) if rules.unknown_blocks => Cell::Blocked,
                (false, _) => Cell::Open,
            });
        }
        Ok(grid)
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

    /// Free cells, the paper's n; unknown ones do not count.
    #[must_use]
    pub fn free_cells(&self) -> usize {
        self.free
    }

    /// Occupied cells.
    #[must_use]
    pub fn occupied_cells(&self) -> usize {
        self.occupied
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

/// Small worlds for tests: one line a row, highest y first, as one draws a map.
#[cfg(test)]
pub(crate) mod drawn {
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
    use std::f64::consts::FRAC_PI_2;

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
    fn rows_run_upwards_from_the_lowest_y() {
        let grid = drawn::grid(&["#..", "..."]);
        assert_eq!(grid.get(0, 1), Some(Cell::Occupied));
        assert_eq!(grid.get(0, 0), Some(Cell::Open));
        assert_eq!(grid.get(0, 2), None);
        assert!(grid.touches_open(0, 1));
    }

    proptest::proptest! {
        #[test]
        fn map_and_cells_round_trip(
            ox in -100.0..100.0f64, oy in -100.0..100.0f64, turn in -3.0..3.0f64,
            resolution_m in 0.01..0.5f64, x in 0.0..3e4f64, y in 0.0..3e4f64, heading in -3.0..3.0f64,
        ) {
            let frame = GridFrame { resolution_m, map_from_grid: Pose::new(ox, oy, turn) };
            let (bx, by, bh) = frame.cells_from_map(frame.map_from_cells(x, y, heading));
            // Positions up to 15 km at 1 cm cells: a rounding is 1e-10 of a cell there.
            proptest::prop_assert!((bx - x).abs() < 1e-7 && (by - y).abs() < 1e-7);
            proptest::prop_assert!(geometry::angle_between(bh, heading) < 1e-12);
        }
    }

    #[test]
    fn a_turned_grid_turns_its_poses() {
        let frame = GridFrame {
            resolution_m: 0.5,
            map_from_grid: Pose::new(10.0, 20.0, FRAC_PI_2),
        };
        let pose = frame.map_from_cells(2.0, 0.0, 0.0);
        assert!(pose.is_within(Pose::new(10.0, 21.0, FRAC_PI_2), 1e-12, 1e-12));
    }
}
