//! Limits of a search: near free cells, in a region, at some headings, away from obstacles.
//!
//! Rays are not limited: they pass everywhere. Poses outside the limits have no votes.

mod config;
mod region;

pub use config::{HeadingInterval, LimitsConfig};
pub use region::Region;

use crate::EngineError;
use crate::directions::Directions;
use crate::fit::distance;
use crate::grid::{Cell, CellSet, Grid, GridFrame};

/// Poses of a grid that are searched.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Limits {
    /// Number of cells along x.
    width: usize,
    /// Cells in which poses are searched; `None` for all.
    cells: Option<CellSet>,
    /// Headings that are searched; `None` for all.
    headings: Option<CellSet>,
}

impl Limits {
    /// Creates no limits, for a grid this many cells wide.
    #[must_use]
    pub fn none(width: usize) -> Self {
        Limits {
            width,
            cells: None,
            headings: None,
        }
    }

    /// Computes the limits of a grid from the settings.
    ///
    /// # Errors
    /// If they exclude every cell of the grid, or every heading.
    pub fn new(
        config: &LimitsConfig,
        frame: GridFrame,
        grid: &Grid,
        directions: &Directions,
    ) -> Result<Self, EngineError> {
        let cells = Self::cells(config, frame, grid);
        if let Some(cells) = &cells
            && !cells.iter().any(|i| grid.cells()[i] == Cell::Open)
        {
            return Err(EngineError::NoCellWithin);
        }
        let headings = config.headings_within.map(|interval| {
            let step = std::f64::consts::TAU / directions.count() as f64;
            let heading = |index: usize| index as f64 * step + frame.map_from_grid.yaw;
            CellSet::of(directions.count(), |index| interval.holds(heading(index)))
        });
        if headings
            .as_ref()
            .is_some_and(|headings| headings.iter().next().is_none())
        {
            return Err(EngineError::NoHeadingWithin(directions.count() as u32));
        }
        Ok(Limits {
            width: grid.width(),
            cells,
            headings,
        })
    }

    fn cells(config: &LimitsConfig, frame: GridFrame, grid: &Grid) -> Option<CellSet> {
        let (width, height) = (grid.width(), grid.height());
        let mut all: Option<CellSet> = None;
        let mut keep = |holds: &dyn Fn(usize) -> bool| match &mut all {
            Some(cells) => cells.retain(holds),
            None => all = Some(CellSet::of(width * height, holds)),
        };
        if grid.has_unknown() {
            let reach = (config.unknown_reach / frame.resolution_m) as f32;
            let distances = distance::transform(width, height, |i| grid.free().holds(i));
            keep(&|i| distances[i] <= reach);
        }
        if config.robot_radius > 0.0 {
            let least = (config.robot_radius / frame.resolution_m) as f32;
            let is_occupied = |i: usize| grid.cells()[i] == Cell::Occupied;
            let distances = distance::transform(width, height, is_occupied);
            keep(&|i| distances[i] >= least);
        }
        if let Some(region) = &config.region {
            keep(&|i| {
                let (x, y) = ((i % width) as f64 + 0.5, (i / width) as f64 + 0.5);
                let middle = frame.map_from_cells(x, y, 0.0);
                region.holds(middle.x, middle.y)
            });
        }
        all
    }

    /// True if poses in the cell at column `x` of row `y` are searched.
    #[must_use]
    pub fn hold_cell(&self, x: usize, y: usize) -> bool {
        let cells = self.cells.as_ref();
        cells.is_none_or(|cells| cells.holds(y * self.width + x))
    }

    /// Open cells of the grid in which poses are searched, in ascending order.
    pub(crate) fn open_cells(&self, grid: &Grid) -> impl Iterator<Item = usize> {
        let is_open = |&i: &usize| grid.cells()[i] == Cell::Open;
        let all = (0..grid.cells().len()).filter(is_open);
        all.filter(|&i| self.cells.as_ref().is_none_or(|cells| cells.holds(i)))
    }

    /// True if a heading is searched.
    #[must_use]
    pub fn hold_heading(&self, heading: usize) -> bool {
        let headings = self.headings.as_ref();
        headings.is_none_or(|headings| headings.holds(heading))
    }

    /// Sets the votes of an image (row by row, at one heading) to 0 in cells that are not searched.
    pub(crate) fn clear(&self, field: &mut [u16], heading: usize) {
        if !self.hold_heading(heading) {
            field.fill(0);
        }
        if let Some(cells) = &self.cells {
            cells.clear_others(field);
        }
    }

    /// Returns the blocks of `side` cells a side, row by row, in any cell of which poses are
    /// searched. An index contains only these blocks.
    pub(crate) fn blocks(&self, side: usize, grid: &Grid) -> CellSet {
        let columns = grid.width().div_ceil(side);
        let mut blocks = CellSet::none(columns * grid.height().div_ceil(side));
        for i in self.open_cells(grid) {
            let (x, y) = (i % grid.width(), i / grid.width());
            blocks.insert(y / side * columns + x / side);
        }
        blocks
    }

    /// Memory in bytes.
    pub(crate) fn bytes(&self) -> usize {
        let sets = self.sets().into_iter().flatten();
        sets.map(CellSet::bytes).sum()
    }

    /// Creates limits with empty sets to be filled in: `by` says if they are by cells and by
    /// headings.
    pub(crate) fn unfilled(grid: &Grid, directions: &Directions, by: [bool; 2]) -> Self {
        let [by_cells, by_headings] = by;
        Limits {
            width: grid.width(),
            cells: by_cells.then(|| CellSet::none(grid.cells().len())),
            headings: by_headings.then(|| CellSet::none(directions.count())),
        }
    }

    /// Cells and headings in which poses are searched; `None` for all.
    pub(crate) fn sets(&self) -> [Option<&CellSet>; 2] {
        [self.cells.as_ref(), self.headings.as_ref()]
    }

    pub(crate) fn sets_mut(&mut self) -> [Option<&mut CellSet>; 2] {
        [self.cells.as_mut(), self.headings.as_mut()]
    }
}

#[cfg(test)]
mod tests {
    use geometry::Pose;

    use super::*;
    use crate::grid::drawn::grid;

    const FRAME: GridFrame =
        GridFrame::new(0.5, Pose::new(10.0, 20.0, std::f64::consts::FRAC_PI_2));

    const ROOM: [&str; 4] = ["######", "#....#", "#....#", "######"];

    fn limits(config: &LimitsConfig) -> Result<Limits, EngineError> {
        limits_on(&ROOM, config)
    }

    fn limits_on(rows: &[&str], config: &LimitsConfig) -> Result<Limits, EngineError> {
        Limits::new(config, FRAME, &grid(rows), &Directions::new(8).unwrap())
    }

    fn drawn(limits: &Limits) -> Vec<String> {
        let row = |y| {
            (0..6)
                .map(|x| if limits.hold_cell(x, y) { '+' } else { '-' })
                .collect()
        };
        (0..4).rev().map(row).collect()
    }

    #[test]
    fn unknown_cells_are_limited_by_how_far_the_next_free_one_is() {
        let drawn_at = |rows: &[&str], unknown_reach| {
            let config = LimitsConfig {
                unknown_reach,
                ..LimitsConfig::default()
            };
            drawn(&limits_on(rows, &config).unwrap())
        };
        // Cells are 0.5 m; occupied ones are limited, too, which does not matter.
        let rows = ["??????", "?????#", "??.???", "??????"];
        let none = ["------", "------", "--+---", "------"];
        assert_eq!(drawn_at(&rows, 0.0), none);
        assert_eq!(drawn_at(&rows, 0.49), none);
        let plus = ["------", "--+---", "-+++--", "--+---"];
        assert_eq!(drawn_at(&rows, 0.5), plus);
        let octagon = ["--+---", "-+++--", "+++++-", "-+++--"];
        assert_eq!(drawn_at(&rows, 1.0), octagon);
        assert_eq!(drawn_at(&rows, 1000.0), ["++++++"; 4]);
        assert_eq!(drawn_at(&ROOM, 0.0), ["++++++"; 4], "nothing is unknown");
    }

    #[test]
    fn where_nothing_is_free_nothing_is_searched() {
        let unknown = limits_on(&["??#", "???"], &LimitsConfig::default());
        assert_eq!(unknown.unwrap_err(), EngineError::NoCellWithin);
    }

    #[test]
    fn a_region_is_one_of_the_map() {
        // The grid's x is along the map's y.
        let config = LimitsConfig {
            region: Some("8.6,20.6 9.4,21.9".parse().unwrap()),
            ..LimitsConfig::default()
        };
        let limits = limits(&config).unwrap();
        assert_eq!(drawn(&limits), ["------", "-+++--", "-+++--", "------"]);
        assert_eq!(
            limits.blocks(4, &grid(&ROOM)),
            CellSet::of(2, |block| block == 0)
        );
        let mut field = vec![7; 24];
        limits.clear(&mut field, 0);
        assert_eq!(field.iter().filter(|&&votes| votes == 7).count(), 6);
    }

    #[test]
    fn a_robot_keeps_off_obstacles() {
        let config = |robot_radius| LimitsConfig {
            robot_radius,
            ..LimitsConfig::default()
        };
        // Cells are 0.5 m: those next to the wall are that far from it.
        let drawn_at = |radius| drawn(&limits(&config(radius)).unwrap());
        assert_eq!(drawn_at(0.5), ["------", "-++++-", "-++++-", "------"]);
        assert_eq!(limits(&config(0.6)).unwrap_err(), EngineError::NoCellWithin);
    }

    #[test]
    fn headings_are_those_of_the_map() {
        let within = |interval: &str| LimitsConfig {
            headings_within: Some(interval.parse().unwrap()),
            ..LimitsConfig::default()
        };
        let limits_of = limits(&within("80,140")).unwrap();
        let held = (0..8).filter(|&heading| limits_of.hold_heading(heading));
        assert_eq!(
            held.collect::<Vec<_>>(),
            [0, 1],
            "the grid is turned by 90 degrees"
        );
        let refused = limits(&within("1,2")).unwrap_err();
        assert_eq!(refused, EngineError::NoHeadingWithin(8));
    }
}
