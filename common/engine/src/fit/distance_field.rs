//! A map as the second stage reads it: how far from obstacles a point is, and
//! what a ray meets on its way.

use super::lanes::{LANES, Lanes, lanes};
use super::{FitConfig, distance, drawing};
use crate::EngineError;
use crate::grid::{Cell, CellRules, Grid, GridFrame};
use crate::instruction_set::InstructionSet;
use crate::simd::Simd;

/// Distances to obstacles and to what is unknown.
#[derive(Debug, Clone)]
pub struct DistanceField {
    /// Where the grid lies in the map.
    pub frame: GridFrame,
    width: usize,
    height: usize,
    /// To the nearest occupied cell, cells between centres.
    to_occupied: Vec<f32>,
    /// To the nearest unknown cell, whole cells, 255 for more.
    to_unknown: Vec<u8>,
    /// How far the map is a drawing, 0..=1.
    drawn_share: f64,
    /// What it is read with.
    pub(super) simd: Simd,
}

/// What a ray hits, in cells from where it starts.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct RayHit {
    /// To the first occupied cell, if it is on the map and near enough.
    pub occupied: Option<f64>,
    /// To the first unknown cell before that.
    pub unknown: Option<f64>,
}

/// Cells that a ray moves on at least; it may miss a corner that it cuts by
/// less.
const MIN_STEP: f64 = 0.5;

/// How far walls lie from where somebody drew them, metres: right answers on a map of
/// offices that was drawn by hand lie 12 cm off, along both axes together.
const DRAWN_ERROR_M: f64 = 0.1;

/// Farther than any reach, cells.
const OFF_THE_MAP: f32 = 1e6;

/// The farthest that a point of a cell and a point of another cell can lie
/// nearer to each other than the centres do.
const SLACK: f64 = std::f64::consts::SQRT_2;

/// Where the best place lacks little itself, the true one does not lack much more than this.
pub(crate) fn lacks(best: f64) -> f64 {
    2.0 * (1.0 - best).max(0.0)
}

impl DistanceField {
    /// Prepares a map of `width · height` occupancies, row by row from the
    /// lowest y.
    ///
    /// # Errors
    /// See [`Grid::new`].
    pub fn new(
        frame: GridFrame,
        (width, height): (usize, usize),
        occupancy: &[u8],
        rules: CellRules,
    ) -> Result<Self, EngineError> {
        // A grid in which unknown cells block distinguishes them.
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

    /// The same, read with the instructions of this set.
    #[cfg(test)]
    pub(super) fn with(self, set: InstructionSet) -> Self {
        let simd = Simd::new(set);
        DistanceField { simd, ..self }
    }

    /// What the map may leave out of the score of the true place, 0..=1, where the best
    /// place has this one: nothing where it was measured, and little where the best lacks
    /// little itself.
    #[must_use]
    pub fn left_out(&self, best: f64, config: &FitConfig) -> f64 {
        self.drawn_share * config.drawn_doubt.min(lacks(best))
    }

    /// The same, however good the best place is: by so much less may the true place on a map
    /// that was measured fit than a wrong one here.
    #[must_use]
    pub fn drawn_doubt(&self, config: &FitConfig) -> f64 {
        self.drawn_share * config.drawn_doubt
    }

    /// What the walls of the map are off by because they were drawn, metres: nothing
    /// where it was measured.
    #[must_use]
    pub fn drawn_error_m(&self) -> f64 {
        self.drawn_share * DRAWN_ERROR_M
    }

    /// Distance of a point to the nearest occupied cell: bilinear between the centres of
    /// cells, and beyond the outermost as at the nearest point between them. `None` off the
    /// map.
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

    /// The distances of points side by side, and how they grow along x and y; off the map
    /// they are far from everything.
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

    /// What a ray from a point in a direction, a vector of length 1, meets
    /// within `limit` cells.
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

    /// Distance of the cell at a point to the nearest occupied one, between the cells'
    /// centres: 0 in an occupied cell, 10⁶ where none is. `None` off the map.
    #[inline(always)]
    #[must_use]
    pub fn cell_distance(&self, x: f64, y: f64) -> Option<f32> {
        self.index(x, y).map(|at| self.to_occupied[at])
    }

    /// Bytes of the distances.
    #[must_use]
    pub fn bytes(&self) -> usize {
        size_of_val(&self.to_occupied[..]) + size_of_val(&self.to_unknown[..])
    }

    /// The cells that are neither occupied nor unknown, row by row.
    pub fn free_cells(&self) -> impl Iterator<Item = usize> {
        let both = self.to_occupied.iter().zip(&self.to_unknown);
        let free = |(occupied, unknown): (&f32, &u8)| *occupied > 0.0 && *unknown > 0;
        both.enumerate()
            .filter(move |&(_, cell)| free(cell))
            .map(|(at, _)| at)
    }

    /// Cells along x.
    #[must_use]
    pub fn width(&self) -> usize {
        self.width
    }

    #[inline(always)]
    fn index(&self, x: f64, y: f64) -> Option<usize> {
        let inside = x >= 0.0 && y >= 0.0 && x < self.width as f64 && y < self.height as f64;
        inside.then(|| y as usize * self.width + x as usize)
    }
}

/// The cells whose centres lie below places along an axis of so many cells, how many cells
/// on the next centres are, which is none behind the last, and how far the places lie on the
/// way there, 0..=1.
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
        // It steps by half a cell at most where it matters.
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
                // Centres of neighbouring cells differ by one cell at most.
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
                // The shortest step enters a cell late, but passes none.
                if hit.occupied.is_some_and(|end| gone > end - MIN_STEP) { break }
                let (x, y) = (start.0 + gone * dx, start.1 + gone * dy);
                let inner = [x, y].iter().all(|c| (0.36..0.64).contains(&c.fract()));
                prop_assert!(!(inner && distance_field.to_occupied[at] == 0.0), "{:?} at {}", hit, gone);
            }
        }
    }
}
