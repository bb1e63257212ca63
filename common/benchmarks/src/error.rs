//! Errors of setting up a case.

use engine::EngineError;

#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum BenchmarksError {
    /// The world is too small for a wall around it.
    #[error("a world of {width} x {height} cells: each side must have at least {least}")]
    WorldSides {
        width: usize,
        height: usize,
        /// Minimum number of cells per side.
        least: usize,
    },
    /// The ratio of boundary cells to free cells is not possible at this size.
    #[error(
        "a world of {width} x {height} cells comes to {reached_percent:.1} % of boundary cells \
         for its free cells: {wanted_percent} % are out of reach"
    )]
    Ratio {
        width: usize,
        height: usize,
        /// Requested ratio of boundary cells to free cells, per cent.
        wanted_percent: f64,
        reached_percent: f64,
    },
    /// No random pose has enough returns.
    #[error("none of {tried} random poses has enough returns")]
    NoPose { tried: usize },
    /// The number of headings is not a multiple of the number of beams.
    #[error("{beams} beams do not fall on a grid of {headings} headings: it must be a multiple")]
    Beams { beams: usize, headings: usize },
    #[error(transparent)]
    Engine(#[from] EngineError),
}
