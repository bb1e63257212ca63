//! Generated worlds of three kinds, each with a given p/n: boundary cells per free cell, the
//! variable of the paper's tables.
//!
//! Walls come first, as dense as the ratio allows; clutter then adds the missing boundary. Above
//! about 25 % the clutter consists of single cells, because larger pieces hide more boundary than
//! they add.

mod canvas;
mod city;
mod clutter;
mod corridors;
mod rooms;

use anyhow::bail;
use engine::boundary;
use engine::grid::{CellRules, Grid};
use engine::space::Space;
use messages::BoundaryCell;
use rand::SeedableRng;
use rand::rngs::Xoshiro256PlusPlus;

use crate::RESOLUTION_M;
use canvas::Canvas;
pub use city::city;

/// Minimum number of cells per side.
const MIN_SIDE: usize = 16;

/// Tolerance of p/n, as a share of the requested value.
const TOLERANCE: f64 = 0.05;

/// Maximum share of the boundary that walls make up.
const WALL_SHARE: f64 = 0.9;

#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, clap::ValueEnum)]
pub enum Kind {
    /// A building: rooms with doors and furniture.
    Rooms,
    /// Long corridors with rooms on both sides that look alike.
    Corridors,
    /// A hall with scattered boxes, rotated at random.
    Boxes,
}

#[derive(Debug, Clone, PartialEq, Eq)]
pub struct World {
    /// The cells, surrounded by a wall.
    pub grid: Grid,
    pub boundary: Vec<BoundaryCell>,
}

impl World {
    /// Generates a world of `width` · `height` cells with `p_over_n` boundary cells per free cell,
    /// within 5 %.
    /// Fails if a side is too short or too long, or the ratio is out of reach at that size: in a
    /// small world the surrounding wall alone has much boundary.
    pub fn generate(
        kind: Kind,
        (width, height): (usize, usize),
        p_over_n: f64,
        seed: u64,
    ) -> anyhow::Result<Self> {
        if width.min(height) < MIN_SIDE {
            bail!("a world of {width} x {height} cells: each side must have at least {MIN_SIDE}");
        }
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(seed);
        let mut canvas = walls(kind, (width, height), p_over_n, &mut rng);
        clutter::add(&mut canvas, kind == Kind::Boxes, p_over_n, &mut rng);
        let grid = Grid::new(width, height, &canvas.occupancy(), CellRules::default())?;
        let boundary = boundary::extract(&grid);
        let world = World { grid, boundary };
        if (world.p_over_n() / p_over_n - 1.0).abs() <= TOLERANCE {
            return Ok(world);
        }
        let (wanted, reached) = (100.0 * p_over_n, 100.0 * world.p_over_n());
        bail!(
            "a world of {width} x {height} cells comes to {reached:.1} % of boundary cells for its \
             free cells: {wanted} % are out of reach"
        )
    }

    /// True at boundary cells, row by row.
    pub(crate) fn is_boundary(&self) -> Vec<bool> {
        let mut is_boundary = vec![false; self.grid.cells().len()];
        for cell in &self.boundary {
            is_boundary[usize::from(cell.y) * self.grid.width() + usize::from(cell.x)] = true;
        }
        is_boundary
    }

    pub fn p_over_n(&self) -> f64 {
        self.boundary.len() as f64 / self.grid.free_cells() as f64
    }

    pub fn space(&self, headings: u32) -> anyhow::Result<Space> {
        let (width, height) = (self.grid.width(), self.grid.height());
        Ok(Space::new(headings, RESOLUTION_M, width, height)?)
    }
}

/// Draws walls as dense as the ratio allows; at least those around the world.
fn walls(
    kind: Kind,
    (width, height): (usize, usize),
    p_over_n: f64,
    rng: &mut Xoshiro256PlusPlus,
) -> Canvas {
    // Both faces of the walls of rooms with side s are 4/s of their cells.
    let mut side = (7.0 / p_over_n).max(80.0);
    loop {
        let mut canvas = Canvas::walled(width, height);
        let spacing = side as usize;
        match kind {
            Kind::Rooms => rooms::build(&mut canvas, spacing, rng),
            Kind::Corridors => corridors::build(&mut canvas, spacing, rng),
            Kind::Boxes => {}
        }
        if canvas.p_over_n() <= WALL_SHARE * p_over_n || spacing > width.max(height) {
            return canvas;
        }
        side *= 1.25;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const KINDS: [Kind; 3] = [Kind::Rooms, Kind::Corridors, Kind::Boxes];

    #[test]
    fn worlds_have_the_ratio_that_was_asked_for() {
        for kind in KINDS {
            for percent in [5.0, 10.0, 25.0, 50.0, 100.0, 120.0] {
                for side in [100, 300] {
                    let world = World::generate(kind, (side, side), percent / 100.0, 1).unwrap();
                    let off = world.p_over_n() * 100.0 / percent;
                    assert!(
                        (off - 1.0).abs() <= TOLERANCE,
                        "{kind:?} {percent} {side}: {off}"
                    );
                    assert_eq!(world.boundary, boundary::extract(&world.grid));
                }
            }
        }
    }

    #[test]
    fn a_seed_gives_one_world() {
        for kind in KINDS {
            let world = |seed| World::generate(kind, (120, 90), 0.1, seed).unwrap();
            assert_eq!(world(3), world(3));
            assert_ne!(world(3), world(4));
        }
    }

    #[test]
    fn what_cannot_be_is_refused() {
        let refused = World::generate(Kind::Rooms, (8, 100), 0.1, 1).unwrap_err();
        let expected = "a world of 8 x 100 cells: each side must have at least 16";
        assert_eq!(refused.to_string(), expected);
        let refused = World::generate(Kind::Boxes, (20, 20), 0.05, 1).unwrap_err();
        assert_eq!(
            refused.to_string(),
            "a world of 20 x 20 cells comes to 23.5 % of boundary cells for its free cells: \
             5 % are out of reach"
        );
    }
}
