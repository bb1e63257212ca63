//! The search space: the directions and the scale of the grid.

use messages::MapHeader;

use crate::EngineError;
use crate::directions::Directions;
use crate::grid;

/// Headings, cell size and extent of a search.
#[derive(Debug, Clone, PartialEq)]
pub struct Space {
    /// Headings, which are also the directions of rays.
    pub directions: Directions,
    /// Side of a cell, in metres.
    pub resolution_m: f64,
    /// Diagonal of the grid in metres; no ray in it is longer.
    pub longest_m: f64,
    /// Largest length of beams that count, in metres: the diagonal or, for maps that are searched
    /// together, the longest diagonal.
    pub reach_m: f64,
}

impl Space {
    /// Makes the space of `headings` headings on a grid of `width · height` cells.
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

    /// Makes beams count up to this length, in metres, if that is more than the diagonal. A beam
    /// longer than the diagonal matches nothing on this map, since it cannot end inside the grid,
    /// and so loses the votes that it has on a larger map.
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

/// Returns the largest length of beams that count on maps that are searched together, in metres:
/// the longest diagonal. So all maps are judged by the same beams.
#[must_use]
pub fn reach_m<'a>(maps: impl IntoIterator<Item = &'a MapHeader>) -> f64 {
    let diagonals = maps.into_iter().map(|map| {
        let sides = (map.width as usize, map.height as usize);
        diagonal_m(map.resolution_m, sides)
    });
    diagonals.fold(0.0, f64::max)
}
