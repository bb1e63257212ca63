//! A map as the second stage reads it: how far from obstacles a point is, and
//! what a ray meets on its way.

use super::distance;
use crate::EngineError;
use crate::grid::{Cell, CellRules, Grid, GridFrame};

/// Distances to obstacles and to what is unknown.
#[derive(Debug, Clone)]
pub struct Terrain {
    /// Where the grid lies in the map.
    pub frame: GridFrame,
    width: usize,
    height: usize,
    /// To the nearest occupied cell, cells between centres.
    to_occupied: Vec<f32>,
    /// To the nearest unknown cell, whole cells, 255 for more.
    to_unknown: Vec<u8>,
}

/// What a ray meets, in cells from where it starts.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Way {
    /// To the first occupied cell, if it is on the map and near enough.
    pub occupied: Option<f64>,
    /// To the first unknown cell before that.
    pub unknown: Option<f64>,
}

/// Cells that a ray moves on at least; it may miss a corner that it cuts by
/// less.
const LEAST_STEP: f64 = 0.5;

/// The farthest that a point of a cell and a point of another cell can lie
/// nearer to each other than the centres do.
const SLACK: f64 = std::f64::consts::SQRT_2;

impl Terrain {
    /// Prepares a map of `width · height` occupancies, row by row from the
    /// lowest y.
    ///
    /// # Errors
    /// See [`Grid::new`].
    pub fn new(
        frame: GridFrame,
        (width, height): (usize, usize),
        occupancy: &[u8],
        rules: CellRules,
    ) -> Result<Self, EngineError> {
        // A grid in which unknown cells block tells them apart.
        let rules = CellRules {
            unknown_blocks: true,
            ..rules
        };
        let grid = Grid::new(width, height, occupancy, rules)?;
        let cells = grid.cells();
        let to_unknown = distance::transform(width, height, |i| cells[i] == Cell::Blocked);
        Ok(Terrain {
            frame,
            width,
            height,
            to_occupied: distance::transform(width, height, |i| cells[i] == Cell::Occupied),
            to_unknown: to_unknown.into_iter().map(|cells| cells as u8).collect(),
        })
    }

    /// Distance of a point to the nearest occupied cell, and how it grows along
    /// x and y: bilinear between the centres of cells. `None` off the map.
    #[inline(always)]
    pub(super) fn distance(&self, x: f64, y: f64) -> Option<(f64, [f64; 2])> {
        let (x, y) = (x - 0.5, y - 0.5);
        if !(x >= 0.0 && y >= 0.0) {
            return None;
        }
        let (column, row) = (x as usize, y as usize);
        if column + 1 >= self.width || row + 1 >= self.height {
            return None;
        }
        let at = row * self.width + column;
        let corner = |i: usize| f64::from(self.to_occupied[i]);
        let (a, b) = (corner(at), corner(at + 1));
        let (c, d) = (corner(at + self.width), corner(at + self.width + 1));
        let (u, v) = (x - column as f64, y - row as f64);
        let (low, high) = (a + u * (b - a), c + u * (d - c));
        let along_x = (b - a) + v * ((d - c) - (b - a));
        Some((low + v * (high - low), [along_x, high - low]))
    }

    /// What a ray from a point in a direction, a vector of length 1, meets
    /// within `limit` cells.
    pub(super) fn look(&self, (x, y): (f64, f64), (dx, dy): (f64, f64), limit: f64) -> Way {
        let mut way = Way {
            occupied: None,
            unknown: None,
        };
        let mut gone = 0.0;
        while gone <= limit {
            let Some(at) = self.index(x + gone * dx, y + gone * dy) else {
                return way;
            };
            let occupied = self.to_occupied[at];
            if occupied == 0.0 {
                way.occupied = Some(gone);
                return way;
            }
            let mut clear = f64::from(occupied);
            if way.unknown.is_none() {
                let unknown = self.to_unknown[at];
                if unknown == 0 {
                    way.unknown = Some(gone);
                } else {
                    clear = clear.min(f64::from(unknown));
                }
            }
            gone += (clear - SLACK).max(LEAST_STEP);
        }
        way
    }

    fn index(&self, x: f64, y: f64) -> Option<usize> {
        let inside = x >= 0.0 && y >= 0.0 && x < self.width as f64 && y < self.height as f64;
        inside.then(|| y as usize * self.width + x as usize)
    }
}
