//! Where rays end, for any cell and direction, in the time of a short search.
//!
//! Each direction's bundle puts every cell on one line. For each line the index
//! keeps the cells in which a ray can end, in order; a range is the way to the
//! next one. It needs memory for the boundary, not for the map: two bytes for
//! each boundary cell and pair of opposite directions, and four for each line.

use messages::BoundaryCell;

use crate::directions::{Direction, Directions};

/// The range of a ray that meets no obstacle.
pub const NO_RANGE: u16 = u16::MAX;

/// For each pair of opposite directions, the ends of rays by line.
#[derive(Debug, Clone)]
pub struct LineIndex {
    bundles: Vec<Bundle>,
}

#[derive(Debug, Clone)]
struct Bundle {
    direction: Direction,
    /// Offset of the first line on the minor axis.
    first_line: i64,
    /// The ends of line `l` are `starts[l]..starts[l + 1]`.
    starts: Vec<u32>,
    /// Position on the major axis times two, plus one where the ray is lost
    /// without a hit; ascending within each line.
    ends: Vec<u16>,
}

impl LineIndex {
    /// Indexes the boundary, and the blocked cells that rays are lost in, of a
    /// grid with the given sides.
    #[must_use]
    pub fn new(
        width: usize,
        height: usize,
        boundary: &[BoundaryCell],
        blocked: &[BoundaryCell],
        directions: &Directions,
    ) -> Self {
        let hits = boundary.iter().map(|&cell| (cell, 0));
        let losses = blocked.iter().map(|&cell| (cell, 1));
        let mut by_x: Vec<(BoundaryCell, u16)> = hits.chain(losses).collect();
        let mut by_y = by_x.clone();
        by_x.sort_unstable_by_key(|(cell, _)| cell.x);
        by_y.sort_unstable_by_key(|(cell, _)| cell.y);
        let half = &directions.all()[..directions.count() / 2];
        let bundles = half.iter().map(|&direction| {
            let (cells, sides) = if direction.x_major {
                (&by_x, (width, height))
            } else {
                (&by_y, (height, width))
            };
            Bundle::new(direction, sides, cells)
        });
        LineIndex {
            bundles: bundles.collect(),
        }
    }

    /// Range in steps from an open cell along the direction of heading `d`;
    /// [`NO_RANGE`] where the ray meets no obstacle.
    #[must_use]
    pub fn range(&self, d: usize, x: usize, y: usize) -> u16 {
        let half = self.bundles.len();
        let (bundle, step) = if d < half {
            (&self.bundles[d], self.bundles[d].direction.step)
        } else {
            (
                &self.bundles[d - half],
                -self.bundles[d - half].direction.step,
            )
        };
        bundle.range(x as i64, y as i64, step > 0)
    }

    /// Bytes that the index takes.
    #[must_use]
    pub fn bytes(&self) -> usize {
        self.bundles
            .iter()
            .map(|bundle| bundle.starts.len() * 4 + bundle.ends.len() * 2)
            .sum()
    }
}

impl Bundle {
    /// Sorts cells, which come by their major coordinate, into lines.
    fn new(
        direction: Direction,
        (major, minor): (usize, usize),
        cells: &[(BoundaryCell, u16)],
    ) -> Self {
        let reach = direction.minor(major as i64 - 1);
        let first_line = -reach.max(0);
        let lines = (minor as i64 - reach.min(0) - first_line) as usize;
        let mut bundle = Bundle {
            direction,
            first_line,
            starts: vec![0; lines + 1],
            ends: vec![0; cells.len()],
        };
        for (cell, _) in cells {
            let (_, line) = bundle.locate(i64::from(cell.x), i64::from(cell.y));
            bundle.starts[line] += 1;
        }
        let mut sum = 0;
        for start in &mut bundle.starts {
            sum += std::mem::replace(start, sum);
        }
        // Filling moves each start to the next line's; shifting them back by
        // one line restores them.
        for &(cell, lost) in cells {
            let (position, line) = bundle.locate(i64::from(cell.x), i64::from(cell.y));
            let slot = bundle.starts[line];
            bundle.ends[slot as usize] = position << 1 | lost;
            bundle.starts[line] = slot + 1;
        }
        bundle.starts.rotate_right(1);
        bundle.starts[0] = 0;
        bundle
    }

    /// Position along the line of a cell, and which line it is.
    fn locate(&self, x: i64, y: i64) -> (u16, usize) {
        let (major, minor) = if self.direction.x_major {
            (x, y)
        } else {
            (y, x)
        };
        (
            major as u16,
            (minor - self.direction.minor(major) - self.first_line) as usize,
        )
    }

    /// Range towards growing or falling positions on the major axis.
    fn range(&self, x: i64, y: i64, upwards: bool) -> u16 {
        let (position, line) = self.locate(x, y);
        let ends = &self.ends[self.starts[line] as usize..self.starts[line + 1] as usize];
        let next = ends.partition_point(|&end| end >> 1 < position);
        let end = if upwards {
            ends.get(next)
        } else {
            next.checked_sub(1).map(|last| &ends[last])
        };
        match end {
            Some(&end) if end & 1 == 0 => (end >> 1).abs_diff(position),
            _ => NO_RANGE,
        }
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::testing::{any_grid, space_of};
    use crate::{boundary, reference};

    proptest! {
        #[test]
        fn ranges_equal_those_of_stepping_along_each_ray(grid in any_grid(), headings in 1u32..10) {
            let space = space_of(&grid, headings * 8);
            let lines = LineIndex::new(
                grid.width(), grid.height(),
                &boundary::extract(&grid), &boundary::blocked(&grid), &space.directions,
            );
            for (x, y) in (0..grid.height()).flat_map(|y| (0..grid.width()).map(move |x| (x, y))) {
                if !grid.is_open(x as i64, y as i64) {
                    continue;
                }
                for (d, direction) in space.directions.all().iter().enumerate() {
                    let range = lines.range(d, x, y);
                    let plain = reference::range(&grid, x as i64, y as i64, direction);
                    prop_assert_eq!(range, plain.unwrap_or(NO_RANGE), "{:?} {:?}", (x, y), direction);
                }
            }
        }
    }
}
