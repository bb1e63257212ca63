//! Distance of each cell to the nearest obstacle, which lets rays skip free cells.

use engine::chessboard;
use engine::directions::Direction;
use engine::grid::Cell;

use crate::worlds::World;

/// Chessboard distance of each cell to the nearest cell that ends a ray. A margin of one cell
/// spares rays the check for the end of the map.
#[derive(Debug, Clone)]
pub(super) struct Clearance {
    stride: usize,
    /// 0 where a ray ends; saturated at 255.
    cells: Vec<u8>,
    occupied: Vec<bool>,
}

impl Clearance {
    pub(super) fn new(world: &World) -> Self {
        let (width, height) = (world.grid.width(), world.grid.height());
        let stride = width + 2;
        let mut clearance = Clearance {
            stride,
            cells: vec![0; stride * (height + 2)],
            occupied: vec![false; stride * (height + 2)],
        };
        for (i, &cell) in world.grid.cells().iter().enumerate() {
            let at = clearance.at(i % width, i / width);
            clearance.cells[at] = if cell == Cell::Open { u8::MAX } else { 0 };
            clearance.occupied[at] = cell == Cell::Occupied;
        }
        chessboard::spread(&mut clearance.cells, stride);
        clearance
    }

    /// Makes rays take single steps, with the same results.
    pub(super) fn with_single_steps(mut self) -> Self {
        self.cells.iter_mut().for_each(|it| *it = (*it).min(1));
        self
    }

    fn at(&self, x: usize, y: usize) -> usize {
        (y + 1) * self.stride + x + 1
    }

    pub(super) fn bytes(&self) -> usize {
        self.cells.len() + self.occupied.len()
    }

    /// Steps to the first occupied cell; `None` if the ray leaves the map or exceeds `limit` steps.
    /// Skipped cells are free, so the result is the same as with single steps.
    #[inline]
    pub(super) fn range(
        &self,
        x: usize,
        y: usize,
        direction: &Direction,
        limit: i64,
    ) -> Option<i64> {
        let (major, major_stride, minor_stride) = match direction.x_major {
            true => (x as i64, 1, self.stride as i64),
            false => (y as i64, self.stride as i64, 1),
        };
        let start = self.at(x, y) as i64 - direction.minor(major) * minor_stride;
        let mut steps = 0;
        let mut at = self.at(x, y);
        loop {
            let leap = i64::from(self.cells[at]);
            if leap == 0 {
                return self.occupied[at].then_some(steps);
            }
            steps += leap;
            if steps > limit {
                return None;
            }
            let along = direction.step * steps;
            let minor = direction.minor(major + along);
            at = (start + along * major_stride + minor * minor_stride) as usize;
        }
    }
}

#[cfg(test)]
mod tests {
    use engine::reference;

    use super::*;
    use crate::worlds::Kind;

    #[test]
    fn leaping_rays_end_where_stepping_ones_do() {
        for (kind, percent) in [(Kind::Rooms, 10.0), (Kind::Boxes, 60.0)] {
            let world = World::generate(kind, (70, 50), percent / 100.0, 2).unwrap();
            let space = world.space(40).unwrap();
            let clearance = Clearance::new(&world);
            let single = clearance.clone().with_single_steps();
            for (x, y) in (0..50).flat_map(|y| (0..70).map(move |x| (x, y))) {
                for direction in space.directions.all() {
                    let plain = reference::range(&world.grid, x as i64, y as i64, direction);
                    let plain = plain.map(i64::from);
                    assert_eq!(clearance.range(x, y, direction, 100), plain);
                    let near = plain.filter(|&steps| steps <= 7);
                    assert_eq!(clearance.range(x, y, direction, 7), near);
                    assert_eq!(single.range(x, y, direction, 100), plain);
                }
            }
        }
    }
}
