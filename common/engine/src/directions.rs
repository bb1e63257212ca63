//! The directions of rays, as bundles of discrete lines.
//!
//! For each direction, every cell is on exactly one line of the bundle, and a direction shares its
//! lines with the opposite one. So projecting back from an obstacle and looking out from a pose
//! meet the same cells.

use std::f64::consts::{FRAC_1_SQRT_2, TAU};

use crate::EngineError;

/// All headings of a turn; heading `h` is the angle `2π h / count` in the grid's frame.
#[derive(Debug, Clone, PartialEq)]
pub struct Directions {
    all: Vec<Direction>,
}

/// One direction: a bundle of lines and a sense along them.
///
/// A ray steps by `step` along its major axis. At the absolute index `j` there, it is `minor(j)`
/// beyond the line's own offset on the minor axis. It deviates from the ideal line by less than one
/// cell.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Direction {
    /// True if x is the major axis: |cos| ≥ |sin|.
    pub x_major: bool,
    /// Step along the major axis, +1 or -1.
    pub step: i64,
    /// Rise on the minor axis for one cell on the major, times 2³².
    slope: i64,
    /// Steps per cell of Euclidean length: max(|cos|, |sin|).
    pub steps_per_cell: f64,
    /// Index of `steps_per_cell` among its `count / 8 + 1` values.
    pub class: usize,
}

impl Directions {
    /// Lists the directions of `count` headings.
    ///
    /// # Errors
    /// If `count` is not a multiple of 8 from 8 to 3600.
    pub fn new(count: u32) -> Result<Self, EngineError> {
        if !count.is_multiple_of(8) || !(8..=3600).contains(&count) {
            return Err(EngineError::Headings(count));
        }
        let count = count as usize;
        Ok(Directions {
            all: (0..count).map(|d| Direction::new(d, count)).collect(),
        })
    }

    /// Number of headings, a multiple of 8.
    pub fn count(&self) -> usize {
        self.all.len()
    }

    /// Number of distinct values of `steps_per_cell`.
    pub fn classes(&self) -> usize {
        self.all.len() / 8 + 1
    }

    /// Returns `steps_per_cell` of a class: the cosine of its angle in the first octant.
    #[must_use]
    pub fn steps_per_cell(&self, class: usize) -> f64 {
        octant_cos_sin(class, self.all.len()).0
    }

    /// Angle from one heading to the next, in radians.
    pub fn spacing(&self) -> f64 {
        TAU / self.all.len() as f64
    }

    /// All directions, by heading.
    pub fn all(&self) -> &[Direction] {
        &self.all
    }

    /// Returns the direction of heading `h`, modulo a turn.
    #[must_use]
    pub fn get(&self, h: usize) -> &Direction {
        &self.all[h % self.all.len()]
    }

    /// Returns the heading nearest to an angle in the grid's frame (half up), and the rounding
    /// remainder in radians.
    #[must_use]
    pub fn nearest(&self, angle: f64) -> (usize, f64) {
        let spacing = self.spacing();
        let rounded = (angle / spacing + 0.5).floor();
        let index = rounded.rem_euclid(self.all.len() as f64) as usize % self.all.len();
        (index, angle - rounded * spacing)
    }
}

/// Returns the direction of a beam at a heading of a turn, as an index; heading and bearing are
/// below `count`.
#[inline(always)]
pub(crate) fn turned(heading: usize, bearing: usize, count: usize) -> usize {
    let direction = heading + bearing;
    if direction < count {
        direction
    } else {
        direction - count
    }
}

impl Direction {
    /// Derives the direction from the first octant, so that mirrored directions have slopes equal
    /// to the last bit.
    fn new(d: usize, count: usize) -> Self {
        let eighth = count / 8;
        let (octant, within) = (d / eighth, d % eighth);
        let class = if octant.is_multiple_of(2) {
            within
        } else {
            eighth - within
        };
        let (cos, sin) = octant_cos_sin(class, count);
        let slope = (sin / cos * 4_294_967_296.0).round() as i64;
        // Octants 0, 3, 4, 7 are along x; the diagonals count as x-major too.
        let x_major = matches!(octant, 0 | 3 | 4 | 7) || class == eighth;
        let (dx, dy) = quadrant_signs(d, count);
        let step = if x_major { dx } else { dy };
        Direction {
            x_major,
            step,
            slope: slope * dx * dy,
            steps_per_cell: cos,
            class,
        }
    }

    /// Returns the position on the minor axis, at major index `j`, of the line with offset 0:
    /// `(j · slope + 2³¹) >> 32`.
    #[must_use]
    pub fn minor(&self, j: i64) -> i64 {
        self.rise(j) >> 32
    }

    /// Returns the same as [`Direction::minor`] with 32 fractional bits; it grows by
    /// [`Direction::slope`] per index.
    #[inline(always)]
    pub(crate) fn rise(&self, j: i64) -> i64 {
        j * self.slope + (1 << 31)
    }

    /// Rise on the minor axis for one cell on the major, times 2³².
    pub(crate) fn slope(&self) -> i64 {
        self.slope
    }

    /// Returns the next cell of a ray.
    #[must_use]
    pub fn advance(&self, x: i64, y: i64) -> (i64, i64) {
        let (major, minor) = self.swap((x, y));
        let next_major = major + self.step;
        let next_minor = minor + self.minor(next_major) - self.minor(major);
        self.swap((next_major, next_minor))
    }

    /// Converts (column, row) to (major, minor) index, or back.
    #[inline(always)]
    pub(crate) fn swap<T>(&self, pair: (T, T)) -> (T, T) {
        swap_unless(self.x_major, pair)
    }

    /// Returns the opposite direction, on the same lines.
    pub fn opposite(&self) -> Direction {
        Direction {
            step: -self.step,
            ..*self
        }
    }
}

/// Converts a pair (x, y) to (major, minor), or back.
#[inline(always)]
pub(crate) fn swap_unless<T>(x_major: bool, (a, b): (T, T)) -> (T, T) {
    if x_major { (a, b) } else { (b, a) }
}

/// Cosine and sine of `2π class / count` in the first octant, exact on the axis and on the
/// diagonal.
fn octant_cos_sin(class: usize, count: usize) -> (f64, f64) {
    if class == count / 8 {
        return (FRAC_1_SQRT_2, FRAC_1_SQRT_2);
    }
    let (sin, cos) = (TAU * class as f64 / count as f64).sin_cos();
    (cos, sin)
}

/// Signs of cosine and sine, +1 on an axis.
fn quadrant_signs(d: usize, count: usize) -> (i64, i64) {
    let quarter = count / 4;
    let dx = if d <= quarter || d > 3 * quarter {
        1
    } else {
        -1
    };
    let dy = if d <= 2 * quarter { 1 } else { -1 };
    (if d == 3 * quarter { 1 } else { dx }, dy)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn refuses_counts_that_are_no_multiples_of_eight() {
        for count in [0, 4, 12, 361, 3608] {
            assert_eq!(Directions::new(count), Err(EngineError::Headings(count)));
        }
    }

    #[test]
    fn rays_follow_their_angle_within_a_cell() {
        for count in [8, 16, 360, 720] {
            let directions = Directions::new(count).unwrap();
            for (d, direction) in directions.all().iter().enumerate() {
                let (sin, cos) = (TAU * d as f64 / f64::from(count)).sin_cos();
                let (x0, y0) = (400, 300);
                let (mut x, mut y) = (x0, y0);
                for steps in 1..=200 {
                    (x, y) = direction.advance(x, y);
                    let length = f64::from(steps) / direction.steps_per_cell;
                    let off = (x - x0) as f64 * sin - (y - y0) as f64 * cos;
                    let along = (x - x0) as f64 * cos + (y - y0) as f64 * sin;
                    assert!(
                        off.abs() <= 1.0,
                        "{count}/{d}: {off} cells off after {steps}"
                    );
                    assert!(
                        (along - length).abs() <= 1.0,
                        "{count}/{d}: {along} not {length}"
                    );
                }
            }
        }
    }

    #[test]
    fn opposite_headings_share_their_lines() {
        let directions = Directions::new(360).unwrap();
        for d in 0..180 {
            assert_eq!(
                directions.get(d).opposite(),
                *directions.get(d + 180),
                "{d}"
            );
        }
    }

    #[test]
    fn the_nearest_heading_is_rounded_half_up() {
        let directions = Directions::new(360).unwrap();
        let at = |degrees: f64| directions.nearest(degrees.to_radians()).0;
        assert_eq!((at(0.4), at(-0.4), at(359.7), at(-90.0)), (0, 0, 0, 270));
        let quarter = Directions::new(8).unwrap();
        assert_eq!(quarter.nearest(TAU / 16.0).0, 1, "exactly between 0 and 1");
    }

    #[test]
    fn diagonals_lie_along_x() {
        let directions = Directions::new(360).unwrap();
        for d in [45, 135, 225, 315] {
            assert!(directions.get(d).x_major, "{d}");
            assert_eq!(directions.get(d).steps_per_cell, FRAC_1_SQRT_2);
        }
    }
}
