//! A map for the second stage: distances of points from obstacles, and obstacles along rays.

use geometry::Pose;

use super::{FitConfig, GridPose, distance, drawing};
use crate::EngineError;
use crate::grid::{Cell, CellRules, Grid, GridFrame};
use crate::instruction_set::InstructionSet;
use crate::simd::Simd;

/// Number of ends in a group.
pub(super) const LANES: usize = 8;

pub(super) type Lanes = [f32; LANES];

/// Computes one value for each lane.
#[inline(always)]
pub(super) fn lanes<T>(of: impl FnMut(usize) -> T) -> [T; LANES] {
    std::array::from_fn(of)
}

/// Distances of the cells of a map to obstacles and to unknown cells.
#[derive(Debug, Clone)]
pub struct DistanceField {
    /// Cell size and pose of the grid in the map.
    pub frame: GridFrame,
    width: usize,
    height: usize,
    /// Distance to the nearest occupied cell, in cells between centres.
    to_occupied: Vec<f32>,
    /// Distance to the nearest unknown cell, in whole cells; 255 for more.
    to_unknown: Vec<u8>,
    /// Degree to which the map is a drawing, 0..=1.
    drawn_share: f64,
    /// Instruction set with which it is read.
    pub(super) simd: Simd,
}

/// Cells that a ray meets, as distances in cells from its start.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct RayHit {
    /// Distance to the first occupied cell; `None` if it is off the map or beyond the limit.
    pub occupied: Option<f64>,
    /// Distance to the first unknown cell before that.
    pub unknown: Option<f64>,
}

/// Smallest step of a ray, in cells; a ray may miss a corner that it cuts by less.
const MIN_STEP: f64 = 0.5;

/// Distance of walls from where they were drawn, in metres: correct poses on a hand-drawn map of
/// offices are 12 cm off, along both axes together.
const DRAWN_ERROR_M: f64 = 0.1;

/// Distance of points off the map, in cells: farther than any reach.
const OFF_THE_MAP: f32 = 1e6;

/// Largest amount, in cells, by which points of two cells can be nearer to each other than the
/// cells' centres.
const SLACK: f64 = std::f64::consts::SQRT_2;

/// Largest score gap between the best place and the true one, given the best score.
pub(crate) fn lacks(best: f64) -> f64 {
    2.0 * (1.0 - best).max(0.0)
}

impl DistanceField {
    /// Prepares a map of `width · height` occupancies, row by row from the lowest y.
    ///
    /// # Errors
    /// See [`Grid::new`].
    pub fn new(
        frame: GridFrame,
        (width, height): (usize, usize),
        occupancy: &[u8],
        rules: CellRules,
    ) -> Result<Self, EngineError> {
        // Unknown cells are distinguished only in a grid in which they block.
        let rules = CellRules {
            unknown_blocks: true,
            ..rules
        };
        let grid = Grid::new(width, height, occupancy, rules)?;
        let cells = grid.cells();
        let to_unknown = distance::transform(width, height, |i| cells[i] == Cell::Blocked);
        Ok(DistanceField {
            frame,
            width,
            height,
            to_occupied: distance::transform(width, height, |i| cells[i] == Cell::Occupied),
            to_unknown: to_unknown.into_iter().map(|cells| cells as u8).collect(),
            drawn_share: drawing::share(&grid, frame.resolution_m),
            simd: Simd::new(InstructionSet::best()),
        })
    }

    /// Makes the field use this instruction set.
    #[cfg(test)]
    pub(super) fn with(self, set: InstructionSet) -> Self {
        let simd = Simd::new(set);
        DistanceField { simd, ..self }
    }

    /// Returns the score that the true place may lack because a drawn map leaves things out, 0..=1,
    /// given the best score: 0 on a measured map, and little if the best score is near 1.
    #[must_use]
    pub fn left_out(&self, best: f64, config: &FitConfig) -> f64 {
        self.drawn_share * config.drawn_doubt.min(lacks(best))
    }

    /// Returns the same without the limit by the best score: the score by which the true place, on
    /// a measured map, may fit worse than a wrong place on this map.
    #[must_use]
    pub fn drawn_doubt(&self, config: &FitConfig) -> f64 {
        self.drawn_share * config.drawn_doubt
    }

    /// Returns the error of the walls that comes from drawing, in metres; 0 on a measured map.
    pub fn drawn_error_m(&self) -> f64 {
        self.drawn_share * DRAWN_ERROR_M
    }

    /// True if the position of a pose is on the map.
    pub(crate) fn holds(&self, pose: Pose) -> bool {
        let GridPose { x, y, .. } = GridPose::of(self.frame, pose);
        let is_within = |cells: usize, at: f64| (0.0..=cells as f64).contains(&at);
        pose.is_finite() && is_within(self.width, x) && is_within(self.height, y)
    }

    /// Distance of a point to the nearest occupied cell, in cells: bilinear between the centres of
    /// cells, and constant beyond the outermost centres. `None` off the map.
    #[inline(always)]
    pub(super) fn distance(&self, x: f64, y: f64) -> Option<f64> {
        let (right, top) = (self.width - 1, self.height - 1);
        if !(x >= 0.0 && y >= 0.0 && x <= self.width as f64 && y <= self.height as f64) {
            return None;
        }
        let (x, y) = ((x - 0.5).max(0.0), (y - 0.5).max(0.0));
        let (column, row) = ((x as usize).min(right), (y as usize).min(top));
        let (u, v) = ((x - column as f64).min(1.0), (y - row as f64).min(1.0));
        let (low_row, high_row) = (row * self.width, (row + 1).min(top) * self.width);
        let next = (column + 1).min(right);
        let corner = |row: usize, column: usize| f64::from(self.to_occupied[row + column]);
        let (a, b) = (corner(low_row, column), corner(low_row, next));
        let (c, d) = (corner(high_row, column), corner(high_row, next));
        let (low, high) = (a + u * (b - a), c + u * (d - c));
        Some(low + v * (high - low))
    }

    /// Distances of eight points, and their derivatives along x and y; points off the map get
    /// [`OFF_THE_MAP`].
    #[inline(always)]
    pub(super) fn distances(&self, x: Lanes, y: Lanes) -> (Lanes, [Lanes; 2]) {
        let (width, height) = (self.width as f32, self.height as f32);
        let is_inside = lanes(|i| x[i] >= 0.0 && y[i] >= 0.0 && x[i] <= width && y[i] <= height);
        let (column, right, u) = between_centres(x, self.width);
        let (row, up, v) = between_centres(y, self.height);
        let corners = lanes(|i| {
            let at = row[i] as usize * self.width + column[i] as usize;
            let (right, up) = (right[i] as usize, up[i] as usize * self.width);
            [at, at + right, at + up, at + up + right].map(|at| self.to_occupied[at])
        });
        let [a, b, c, d] = std::array::from_fn(|corner| lanes(|i| corners[i][corner]));
        let low = lanes(|i| a[i] + u[i] * (b[i] - a[i]));
        let along_y = lanes(|i| c[i] + u[i] * (d[i] - c[i]) - low[i]);
        let along_x = lanes(|i| (b[i] - a[i]) + v[i] * ((d[i] - c[i]) - (b[i] - a[i])));
        let distance = lanes(|i| match is_inside[i] {
            true => low[i] + v[i] * along_y[i],
            false => OFF_THE_MAP,
        });
        (distance, [along_x, along_y])
    }

    /// Returns what a ray meets within `limit` cells, from a point in a direction (a unit vector).
    pub(crate) fn cast_ray(&self, (x, y): (f64, f64), (dx, dy): (f64, f64), limit: f64) -> RayHit {
        let mut hit = RayHit {
            occupied: None,
            unknown: None,
        };
        let mut gone = 0.0;
        while gone <= limit {
            let Some(at) = self.index(x + gone * dx, y + gone * dy) else {
                return hit;
            };
            let occupied = self.to_occupied[at];
            if occupied == 0.0 {
                hit.occupied = Some(gone);
                return hit;
            }
            let mut clear = f64::from(occupied);
            if hit.unknown.is_none() {
                let unknown = self.to_unknown[at];
                if unknown == 0 {
                    hit.unknown = Some(gone);
                } else {
                    clear = clear.min(f64::from(unknown));
                }
            }
            gone += (clear - SLACK).max(MIN_STEP);
        }
        hit
    }

    /// Returns the distance of the cell at a point to the nearest occupied cell, between centres: 0
    /// in an occupied cell, 10⁶ if there is none. `None` off the map.
    #[inline(always)]
    #[must_use]
    pub fn cell_distance(&self, x: f64, y: f64) -> Option<f32> {
        self.index(x, y).map(|at| self.to_occupied[at])
    }

    /// Memory of the distances in bytes.
    pub fn bytes(&self) -> usize {
        size_of_val(&self.to_occupied[..]) + size_of_val(&self.to_unknown[..])
    }

    /// Indices of the cells that are neither occupied nor unknown, row by row.
    pub fn free_cells(&self) -> impl Iterator<Item = usize> {
        let both = self.to_occupied.iter().zip(&self.to_unknown);
        let free = |(occupied, unknown): (&f32, &u8)| *occupied > 0.0 && *unknown > 0;
        both.enumerate()
            .filter(move |&(_, cell)| free(cell))
            .map(|(at, _)| at)
    }

    /// Number of cells along x.
    pub fn width(&self) -> usize {
        self.width
    }

    #[inline(always)]
    fn index(&self, x: f64, y: f64) -> Option<usize> {
        let inside = x >= 0.0 && y >= 0.0 && x < self.width as f64 && y < self.height as f64;
        inside.then(|| y as usize * self.width + x as usize)
    }
}

/// Interpolates places along an axis of `cells` cells. Returns the cell whose centre is below each
/// place, the step to the next centre (1, or 0 at the last), and the fraction of the way there,
/// 0..=1.
#[inline(always)]
fn between_centres(places: Lanes, cells: usize) -> ([u32; LANES], [u32; LANES], Lanes) {
    let last = cells as u32 - 1;
    let places = places.map(|place| (place - 0.5).max(0.0).min(last as f32));
    let below = places.map(|place| place as u32);
    let next = below.map(|below| u32::from(below < last));
    (below, next, lanes(|i| places[i] - below[i] as f32))
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::fit::drawn::{distance_field, field_of};

    #[test]
    fn distance_is_bilinear_between_the_centres_of_cells() {
        let distance_field = distance_field(&["....", "#...", "...."]);
        let at = |x, y| distance_field.distance(x, y);
        assert_eq!(
            (at(1.5, 1.5), at(1.0, 1.5), at(4.0, 1.5)),
            (Some(1.0), Some(0.5), Some(3.0))
        );
        for (x, y) in [(-0.1, 1.5), (4.1, 1.5), (1.5, 3.1), (f64::NAN, 1.0)] {
            assert_eq!(at(x, y), None, "{x} {y}");
        }
        let (distance, slope) = distance_field.distances([1.5; LANES], [1.5; LANES]);
        assert_eq!(
            (distance[0], slope[0][0], slope[1][0]),
            (1.0, 1.0, 2f32.sqrt() - 1.0)
        );
    }

    #[test]
    fn a_ray_meets_the_first_obstacle_and_what_is_unknown_before_it() {
        let distance_field = distance_field(&["......?..#..#"]);
        let from = |x, limit| distance_field.cast_ray((x, 0.5), (1.0, 0.0), limit);
        let hit = from(0.5, 20.0);
        // Near obstacles it steps by half a cell at most.
        assert!((8.5..9.0).contains(&hit.occupied.unwrap()), "{hit:?}");
        assert!((5.5..6.0).contains(&hit.unknown.unwrap()), "{hit:?}");
        assert_eq!(from(7.5, 20.0).unknown, None);
        assert_eq!(from(0.5, 8.0).occupied, None, "beyond the limit");
        let back = distance_field.cast_ray((8.5, 0.5), (-1.0, 0.0), 20.0);
        assert_eq!(back.occupied, None, "it leaves the map");
    }

    proptest! {
        #[test]
        fn points_side_by_side_are_as_far_as_one_by_one(
            grid in crate::testing::any_grid(),
            points in proptest::array::uniform8((-2.0..42.0f64, -2.0..42.0f64)),
        ) {
            let field = field_of(&grid);
            let (distances, slopes) = field.distances(
                points.map(|(x, _)| x as f32),
                points.map(|(_, y)| y as f32),
            );
            for (i, (x, y)) in points.into_iter().enumerate() {
                let (x, y) = (f64::from(x as f32), f64::from(y as f32));
                let expected = field.distance(x, y).unwrap_or(f64::from(OFF_THE_MAP));
                prop_assert!((f64::from(distances[i]) - expected).abs() <= 1e-5 * expected.max(1.0));
                // Distances of neighbouring cells differ by at most one cell.
                prop_assert!(slopes.iter().all(|slope| slope[i].abs() < 1.0 + 1e-5));
            }
        }

        #[test]
        fn a_long_step_passes_no_obstacle(
            grid in crate::testing::any_grid(), start in (0.0..40.0f64, 0.0..40.0f64), angle in 0.0..7.0f64,
        ) {
            let distance_field = field_of(&grid);
            let (dy, dx) = angle.sin_cos();
            let hit = distance_field.cast_ray(start, (dx, dy), 100.0);
            // Steps of a tenth of a cell, until the ray ends.
            for step in 0..1000 {
                let gone = 0.1 * f64::from(step);
                let Some(at) = distance_field.index(start.0 + gone * dx, start.1 + gone * dy) else { break };
                // A ray may enter a cell one shortest step late, but passes through none.
                if hit.occupied.is_some_and(|end| gone > end - MIN_STEP) { break }
                let (x, y) = (start.0 + gone * dx, start.1 + gone * dy);
                let inner = [x, y].iter().all(|c| (0.36..0.64).contains(&c.fract()));
                prop_assert!(!(inner && distance_field.to_occupied[at] == 0.0), "{:?} at {}", hit, gone);
            }
        }
    }
}
