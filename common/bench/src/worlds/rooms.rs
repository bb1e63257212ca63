//! A building: the ground is split recursively into rooms, and every wall has doors.

use rand::RngExt;
use rand::rngs::Xoshiro256PlusPlus;

use super::canvas::{Canvas, Rect};

/// Thickness of an inner wall in cells.
pub(super) const WALL: usize = 2;

/// Width of a door in cells.
pub(super) const DOOR: usize = 18;

/// Draws rooms with sides of about `spacing` cells.
pub(super) fn build(canvas: &mut Canvas, spacing: usize, rng: &mut Xoshiro256PlusPlus) {
    let mut doors = Vec::new();
    let mut grounds = vec![Rect::new(1, 1, canvas.width - 2, canvas.height - 2)];
    while let Some(ground) = grounds.pop() {
        // Limits from one to one and a half spacings give rooms of many sizes.
        let limit = rng.random_range(spacing..=spacing + spacing / 2);
        if ground.width.max(ground.height) > limit {
            grounds.extend(split(canvas, ground, spacing, &mut doors, rng));
        }
    }
    // Doors come last, so that no later wall closes one.
    for door in doors {
        canvas.clear(door);
    }
}

/// Draws a wall across the longer side and returns the grounds on both sides.
fn split(
    canvas: &mut Canvas,
    ground: Rect,
    spacing: usize,
    doors: &mut Vec<Rect>,
    rng: &mut Xoshiro256PlusPlus,
) -> [Rect; 2] {
    let (x, y, width, height) = (ground.x, ground.y, ground.width, ground.height);
    let (long, across) = (width.max(height), width.min(height));
    let at = rng.random_range(long * 3 / 8..=long * 5 / 8);
    let rest = long - at - WALL;
    let along = |start, length| match width >= height {
        true => Rect::new(x + start, y, length, height),
        false => Rect::new(x, y + start, width, length),
    };
    canvas.fill(along(at, WALL));
    for start in (0..across).step_by(2 * spacing) {
        let room = (across - start).min(2 * spacing);
        let room = room.saturating_sub(DOOR).max(1);
        let offset = start + rng.random_range(0..room);
        let wall = along(at, WALL);
        doors.push(match width >= height {
            true => Rect::new(wall.x, y + offset, wall.width, DOOR),
            false => Rect::new(x + offset, wall.y, DOOR, wall.height),
        });
    }
    [along(0, at), along(at + WALL, rest)]
}
