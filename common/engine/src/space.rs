//! The space that is searched: the directions and the scale of the grid.

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
        Ok(Space {
            directions: Directions::new(headings)?,
            resolution_m,
            longest_m: (width as f64).hypot(height as f64) * resolution_m,
        })
    }
}
