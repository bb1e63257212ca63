//! Long corridors with rooms on both sides, crossed by a few others: places that look alike.

use rand::RngExt;
use rand::rngs::Xoshiro256PlusPlus;

use super::canvas::{Canvas, Rect};
use super::rooms::{DOOR, WALL};

/// Minimum width of a corridor in cells: 1.5 m.
const MIN_CORRIDOR: usize = 30;

/// Draws corridors along x with rooms about `spacing` cells deep.
pub(super) fn build(canvas: &mut Canvas, spacing: usize, rng: &mut Xoshiro256PlusPlus) {
    let corridor = (spacing / 3).max(MIN_CORRIDOR);
    let mut y = 1;
    while y + spacing + corridor < canvas.height {
        row_of_rooms(canvas, (y, y + spacing), spacing, y + spacing, rng);
        let bottom = y + spacing + WALL;
        let top = bottom + corridor;
        let rows = (top + WALL, top + WALL + spacing);
        row_of_rooms(canvas, rows, spacing, top, rng);
        let back = top + WALL + spacing;
        canvas.fill(Rect::new(0, back, canvas.width, WALL));
        y = back + WALL;
    }
    cross(canvas, corridor, 8 * spacing);
}

/// Draws rooms between two heights, and their wall to the corridor, with a door per room.
fn row_of_rooms(
    canvas: &mut Canvas,
    (bottom, top): (usize, usize),
    spacing: usize,
    wall: usize,
    rng: &mut Xoshiro256PlusPlus,
) {
    let full = Rect::new(0, wall, canvas.width, WALL);
    canvas.fill(full);
    let mut x = 1;
    while x < canvas.width {
        let width = rng.random_range(spacing * 3 / 4..=spacing * 5 / 4);
        canvas.fill(Rect::new(x + width, bottom, WALL, top - bottom));
        canvas.clear(Rect {
            x: x + rng.random_range(0..width - DOOR),
            width: DOOR,
            ..full
        });
        x += width + WALL;
    }
}

/// Clears corridors along y at this spacing.
fn cross(canvas: &mut Canvas, corridor: usize, apart: usize) {
    let mut x = apart / 2;
    while x + corridor < canvas.width {
        canvas.clear(Rect::new(x, 1, corridor, canvas.height - 2));
        x += apart;
    }
}
