//! Casts rays through the occupied cells of a map, each a solid square.

use geometry::Pose;
use map::{OccupancyGrid, UNKNOWN};

/// Occupancy from which a cell is an obstacle, per cent: the default of map savers.
const OCCUPIED_FROM: u8 = 65;

/// Obstacles of a map. Unknown cells are not obstacles.
#[derive(Debug)]
pub struct Obstacles {
    sides: [i64; 2],
    resolution_m: f64,
    map_from_grid: Pose,
    grid_from_map: Pose,
    occupied: Vec<bool>,
}

/// Progress of a ray along one axis of the grid, in cells.
#[derive(Debug, Clone, Copy)]
struct Axis {
    cell: i64,
    step: i64,
    /// Distance along the ray to the next cell border.
    next: f64,
    /// Distance along the ray between cell borders.
    apart: f64,
}

impl Axis {
    fn new(start: f64, slope: f64) -> Self {
        let cell = start.floor();
        let ahead = if slope > 0.0 {
            cell + 1.0 - start
        } else {
            start - cell
        };
        Axis {
            cell: cell as i64,
            step: if slope > 0.0 { 1 } else { -1 },
            // A ray parallel to the other axis never reaches the next cell.
            next: if slope == 0.0 {
                f64::INFINITY
            } else {
                ahead / slope.abs()
            },
            apart: 1.0 / slope.abs(),
        }
    }

    /// Moves to the next cell; returns the distance of its border along the ray.
    fn advance(&mut self) -> f64 {
        let entered = self.next;
        self.cell += self.step;
        self.next += self.apart;
        entered
    }
}

impl Obstacles {
    pub fn of(map: &OccupancyGrid) -> Self {
        let is_occupied = |&cell: &u8| cell >= OCCUPIED_FROM && cell != UNKNOWN;
        Obstacles {
            sides: [map.width.into(), map.height.into()],
            resolution_m: map.resolution_m,
            map_from_grid: map.map_from_grid,
            grid_from_map: map.map_from_grid.inverse(),
            occupied: map.cells.iter().map(is_occupied).collect(),
        }
    }

    /// Minimum and maximum of the map's corners along x and along y, in metres.
    pub(crate) fn extent(&self) -> [[f64; 2]; 2] {
        let [width, height] = self.sides.map(|side| side as f64 * self.resolution_m);
        let corners = [(0.0, 0.0), (width, 0.0), (0.0, height), (width, height)]
            .map(|(x, y)| self.map_from_grid.transform(x, y));
        let span = |values: [f64; 4]| {
            let least = values.into_iter().fold(f64::INFINITY, f64::min);
            [least, values.into_iter().fold(f64::NEG_INFINITY, f64::max)]
        };
        [span(corners.map(|(x, _)| x)), span(corners.map(|(_, y)| y))]
    }

    /// True if the point is on the map.
    pub(crate) fn holds(&self, x: f64, y: f64) -> bool {
        let [column, row] = self.cells(x, y).map(|cells| cells.floor() as i64);
        self.at(column, row).is_some()
    }

    /// Range of a ray from a point on the map to the first obstacle, in metres: 0 from inside one,
    /// and `None` if it leaves the map or exceeds `reach_m` first.
    ///
    /// Walks from cell to cell (Amanatides and Woo, A Fast Voxel Traversal Algorithm for Ray
    /// Tracing, 1987); the range ends where the ray enters the square, up to rounding.
    pub fn range(&self, x: f64, y: f64, angle: f64, reach_m: f64) -> Option<f64> {
        let [start_x, start_y] = self.cells(x, y);
        let (sin, cos) = (angle + self.grid_from_map.yaw).sin_cos();
        let (mut along_x, mut along_y) = (Axis::new(start_x, cos), Axis::new(start_y, sin));
        let reach = reach_m / self.resolution_m;
        let mut entered = 0.0;
        loop {
            let is_occupied = self.at(along_x.cell, along_y.cell)?;
            if entered > reach {
                return None;
            }
            if is_occupied {
                return Some(entered * self.resolution_m);
            }
            let nearest = match along_x.next < along_y.next {
                true => &mut along_x,
                false => &mut along_y,
            };
            entered = nearest.advance();
        }
    }

    /// True if the line between two points on the map is free.
    pub(crate) fn is_free(&self, from: [f64; 2], to: [f64; 2]) -> bool {
        let [dx, dy] = [to[0] - from[0], to[1] - from[1]];
        self.holds(to[0], to[1])
            && self
                .range(from[0], from[1], dy.atan2(dx), dx.hypot(dy))
                .is_none()
    }

    fn cells(&self, x: f64, y: f64) -> [f64; 2] {
        let (x, y) = self.grid_from_map.transform(x, y);
        [x / self.resolution_m, y / self.resolution_m]
    }

    /// True if the cell is occupied; `None` outside the map.
    fn at(&self, column: i64, row: i64) -> Option<bool> {
        let [width, height] = self.sides;
        let inside = (0..width).contains(&column) && (0..height).contains(&row);
        inside.then(|| self.occupied[(row * width + column) as usize])
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI, TAU};

    use super::*;

    /// Five by five cells of 0.5 m, with a pillar in the middle.
    fn pillar() -> OccupancyGrid {
        let mut cells = vec![0; 25];
        cells[12] = 100;
        OccupancyGrid::from_parts(5, 5, 0.5, Pose::IDENTITY, cells).unwrap()
    }

    #[track_caller]
    fn check(from: [f64; 2], angle: f64, expected: Option<f64>) {
        let range = Obstacles::of(&pillar()).range(from[0], from[1], angle, 10.0);
        match (range, expected) {
            // Tolerance for a few roundings of numbers near 1.
            (Some(range), Some(expected)) => assert!((range - expected).abs() < 1e-12, "{range}"),
            _ => assert_eq!(range, expected),
        }
    }

    #[test]
    fn a_ray_ends_where_it_enters_the_square() {
        check([0.2, 1.25], 0.0, Some(0.8));
        check([2.3, 1.25], PI, Some(0.8));
        check([1.25, 0.1], FRAC_PI_2, Some(0.9));
        check([0.3, 0.3], FRAC_PI_4, Some(0.7 * 2f64.sqrt()));
        check([1.2, 1.2], 1.0, Some(0.0));
        check([0.2, 0.9], 0.0, None);
        check([0.2, 1.25], PI, None);
    }

    #[test]
    fn a_ray_ends_with_its_reach() {
        let obstacles = Obstacles::of(&pillar());
        assert_eq!(obstacles.range(0.2, 1.25, 0.0, 0.79), None);
        assert!(obstacles.range(0.2, 1.25, 0.0, 0.81).is_some());
        assert!(obstacles.is_free([0.2, 1.25], [0.9, 1.25]));
        assert!(!obstacles.is_free([0.2, 1.25], [2.2, 1.25]));
        assert!(!obstacles.is_free([0.2, 1.25], [-0.2, 1.25]), "off the map");
    }

    proptest::proptest! {
        #[test]
        fn a_turned_map_is_seen_the_same(
            x in 0.0..2.5f64, y in 0.0..2.5f64, angle in -TAU..TAU,
            ox in -1e3..1e3f64, oy in -1e3..1e3f64, yaw in -PI..PI,
        ) {
            let mut map = pillar();
            let plain = Obstacles::of(&map).range(x, y, angle, 10.0);
            map.map_from_grid = Pose::new(ox, oy, yaw);
            let (tx, ty) = map.map_from_grid.transform(x, y);
            let turned = Obstacles::of(&map).range(tx, ty, angle + yaw, 10.0);
            // Rays that graze a corner may miss it by a rounding of 1e-10 m.
            if let (Some(plain), Some(turned)) = (plain, turned) {
                proptest::prop_assert!((plain - turned).abs() < 1e-6);
            } else if plain != turned {
                let missed = plain.or(turned).unwrap();
                let (hx, hy) = (x + missed * angle.cos(), y + missed * angle.sin());
                let off = |v: f64| (v - 1.0).abs().min((v - 1.5).abs());
                proptest::prop_assert!(off(hx).max(off(hy)) < 1e-6, "{hx} {hy}");
            }
        }
    }
}
