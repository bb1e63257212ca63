//! Errors when a case is set up.

use engine::EngineError;

/// A case that cannot be set up.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum BenchmarksError {
    /// The world is too small to have a wall around it.
    #[error("a world of {width} x {height} cells: each side must have at least {least}")]
    WorldSides {
        /// Cells along x.
        width: usize,
        /// Cells along y.
        height: usize,
        /// Fewest cells a side.
        least: usize,
    },
    /// A world of this size cannot have so few or so many boundary cells.
    #[error(
        "a world of {width} x {height} cells comes to {reached_percent:.1} % of boundary cells \
         for its free cells: {wanted_percent} % are out of reach"
    )]
    Ratio {
        /// Cells along x.
        width: usize,
        /// Cells along y.
        height: usize,
        /// Boundary cells over free cells asked for, per cent.
        wanted_percent: f64,
        /// What was reached.
        reached_percent: f64,
    },
    /// From nowhere in the world enough beams return.
    #[error("none of {tried} random poses has enough returns")]
    NoPose {
        /// Poses that were tried.
        tried: usize,
    },
    /// A number of beams that the heading grid cannot hold.
    #[error("{beams} beams do not fall on a grid of {headings} headings: it must be a multiple")]
    Beams {
        /// Beams a turn.
        beams: usize,
        /// Headings a turn.
        headings: usize,
    },
    /// The engine refused the case.
    #[error(transparent)]
    Engine(#[from] EngineError),
}
