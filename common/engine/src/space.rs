//! The space that is searched: the directions and the scale of the grid.

use messages::MapHeader;

use crate::EngineError;
use crate::directions::Directions;
use crate::grid;

/// Headings, cell size and extent of a search.
#[derive(Debug, Clone, PartialEq)]
pub struct Space {
    /// The headings, which are also the directions of rays.
    pub directions: Directions,
    /// Side of a cell, metres.
    pub resolution_m: f64,
    /// The grid's diagonal in metres; no ray in it is longer.
    pub longest_m: f64,
    /// Beams count up to this length, metres: that of the diagonal, and of maps that are
    /// searched together that of the longest one.
    pub reach_m: f64,
}

impl Space {
    /// The space of `headings` headings on a grid of `width · height` cells.
    ///
    /// # Errors
    /// If the number of headings is not supported, or the resolution is out of
    /// range.
    pub fn new(
        headings: u32,
        resolution_m: f64,
        width: usize,
        height: usize,
    ) -> Result<Self, EngineError> {
        grid::check_resolution(resolution_m)?;
        let longest_m = diagonal_m(resolution_m, (width, height));
        Ok(Space {
            directions: Directions::new(headings)?,
            resolution_m,
            longest_m,
            reach_m: longest_m,
        })
    }

    /// The same where beams count up to this length, metres, if that is more. One that is
    /// longer than the diagonal fits nothing here, for it cannot end inside the grid, and what
    /// it would have on a larger map is missing.
    #[must_use]
    pub fn reaching(self, reach_m: f64) -> Self {
        Space {
            reach_m: reach_m.max(self.longest_m),
            ..self
        }
    }
}

fn diagonal_m(resolution_m: f64, (width, height): (usize, usize)) -> f64 {
    (width as f64).hypot(height as f64) * resolution_m
}

/// How long beams may be that count on maps that are searched together, metres: the longest
/// diagonal. So all of them are judged by the same beams.
#[must_use]
pub fn reach_m<'a>(maps: impl IntoIterator<Item = &'a MapHeader>) -> f64 {
    let diagonals = maps.into_iter().map(|map| {
        let sides = (map.width as usize, map.height as usize);
        diagonal_m(map.resolution_m, sides)
    });
    diagonals.fold(0.0, f64::max)
}
