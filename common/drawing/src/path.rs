//! Outlines of shapes.

/// Distance of the handles of a quarter circle as a Bézier curve from its ends, per radius.
const QUARTER: f64 = 0.552_284_749_8;

/// A rectangle along the axes, in pixels.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rect {
    /// Left edge.
    pub x: f64,
    /// Upper edge.
    pub y: f64,
    pub width: f64,
    pub height: f64,
}

impl Rect {
    /// A rectangle from its upper left corner and sides.
    #[must_use]
    pub const fn new(x: f64, y: f64, width: f64, height: f64) -> Self {
        Rect {
            x,
            y,
            width,
            height,
        }
    }

    #[must_use]
    pub fn right(&self) -> f64 {
        self.x + self.width
    }

    #[must_use]
    pub fn bottom(&self) -> f64 {
        self.y + self.height
    }

    #[must_use]
    pub fn center(&self) -> (f64, f64) {
        (self.x + self.width / 2.0, self.y + self.height / 2.0)
    }

    /// True if both have a common area.
    #[must_use]
    pub fn overlaps(&self, other: &Rect) -> bool {
        self.x < other.right()
            && other.x < self.right()
            && self.y < other.bottom()
            && other.y < self.bottom()
    }

    /// True if the other rectangle is inside.
    #[must_use]
    pub fn holds(&self, other: &Rect) -> bool {
        self.x <= other.x
            && self.y <= other.y
            && other.right() <= self.right()
            && other.bottom() <= self.bottom()
    }

    /// Moves each edge inwards by this, or outwards if negative.
    #[must_use]
    pub fn shrunk(&self, by: f64) -> Self {
        Rect::new(
            self.x + by,
            self.y + by,
            (self.width - 2.0 * by).max(0.0),
            (self.height - 2.0 * by).max(0.0),
        )
    }
}

/// A segment of an outline; each begins at the end of the one before.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Piece {
    Move((f64, f64)),
    Line((f64, f64)),
    /// Handle and end.
    Quadratic((f64, f64), (f64, f64)),
    /// Both handles and end.
    Cubic((f64, f64), (f64, f64), (f64, f64)),
    Close,
}

/// Any number of outlines. They are filled by the nonzero rule: an outline inside another is a hole
/// if it has the opposite direction.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Path {
    pub(crate) pieces: Vec<Piece>,
}

impl Path {
    #[must_use]
    pub fn new() -> Self {
        Path::default()
    }

    pub fn move_to(&mut self, x: f64, y: f64) {
        self.pieces.push(Piece::Move((x, y)));
    }

    /// Adds a straight line from the current point.
    pub fn line_to(&mut self, x: f64, y: f64) {
        self.pieces.push(Piece::Line((x, y)));
    }

    pub fn close(&mut self) {
        self.pieces.push(Piece::Close);
    }

    pub fn add_line(&mut self, (x0, y0): (f64, f64), (x1, y1): (f64, f64)) {
        self.move_to(x0, y0);
        self.line_to(x1, y1);
    }

    pub fn add_polyline(&mut self, points: impl IntoIterator<Item = (f64, f64)>) {
        for (i, (x, y)) in points.into_iter().enumerate() {
            match i {
                0 => self.move_to(x, y),
                _ => self.line_to(x, y),
            }
        }
    }

    pub fn add_polygon(&mut self, points: impl IntoIterator<Item = (f64, f64)>) {
        self.add_polyline(points);
        self.close();
    }

    pub fn add_rect(&mut self, rect: Rect) {
        let (right, bottom) = (rect.right(), rect.bottom());
        self.add_polygon([
            (rect.x, rect.y),
            (right, rect.y),
            (right, bottom),
            (rect.x, bottom),
        ]);
    }

    pub fn add_circle(&mut self, center: (f64, f64), radius: f64) {
        self.add_ellipse(center, (radius, radius), 0.0);
    }

    /// Adds an ellipse of two half axes, the first of them turned by `angle` radians from the
    /// picture's x axis towards its y axis, which appears clockwise.
    pub fn add_ellipse(&mut self, (x, y): (f64, f64), (a, b): (f64, f64), angle: f64) {
        let (sin, cos) = angle.sin_cos();
        let at = |u: f64, v: f64| (x + a * u * cos - b * v * sin, y + a * u * sin + b * v * cos);
        let (start_x, start_y) = at(1.0, 0.0);
        self.move_to(start_x, start_y);
        for (u, v) in [(1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0)] {
            // A quarter from (u, v) to (-v, u).
            self.pieces.push(Piece::Cubic(
                at(u - QUARTER * v, v + QUARTER * u),
                at(-v + QUARTER * u, u + QUARTER * v),
                at(-v, u),
            ));
        }
        self.close();
    }

    #[must_use]
    pub fn rect(rect: Rect) -> Self {
        let mut path = Path::new();
        path.add_rect(rect);
        path
    }

    #[must_use]
    pub fn circle(center: (f64, f64), radius: f64) -> Self {
        let mut path = Path::new();
        path.add_circle(center, radius);
        path
    }

    #[must_use]
    pub fn line(from: (f64, f64), to: (f64, f64)) -> Self {
        let mut path = Path::new();
        path.add_line(from, to);
        path
    }

    /// An open line through points.
    #[must_use]
    pub fn polyline(points: impl IntoIterator<Item = (f64, f64)>) -> Self {
        let mut path = Path::new();
        path.add_polyline(points);
        path
    }

    /// A closed line through points.
    #[must_use]
    pub fn polygon(points: impl IntoIterator<Item = (f64, f64)>) -> Self {
        let mut path = Path::new();
        path.add_polygon(points);
        path
    }

    /// Rotates the outlines by 90° about a point, so that text to the right runs upwards.
    #[must_use]
    pub fn turned_up(&self, (x, y): (f64, f64)) -> Self {
        let turn = |(u, v): (f64, f64)| (x + (v - y), y - (u - x));
        let pieces = self.pieces.iter().map(|piece| match *piece {
            Piece::Move(to) => Piece::Move(turn(to)),
            Piece::Line(to) => Piece::Line(turn(to)),
            Piece::Quadratic(handle, to) => Piece::Quadratic(turn(handle), turn(to)),
            Piece::Cubic(a, b, to) => Piece::Cubic(turn(a), turn(b), turn(to)),
            Piece::Close => Piece::Close,
        });
        Path {
            pieces: pieces.collect(),
        }
    }

    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.pieces.is_empty()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// End points of the segments.
    fn corners(path: &Path) -> Vec<(f64, f64)> {
        let end = |piece: &Piece| match *piece {
            Piece::Move(to)
            | Piece::Line(to)
            | Piece::Quadratic(_, to)
            | Piece::Cubic(_, _, to) => Some(to),
            Piece::Close => None,
        };
        path.pieces.iter().filter_map(end).collect()
    }

    #[test]
    fn rectangles_that_touch_do_not_overlap() {
        let rect = Rect::new(1.0, 1.0, 2.0, 2.0);
        assert!(rect.overlaps(&Rect::new(2.0, 2.0, 5.0, 5.0)));
        assert!(!rect.overlaps(&Rect::new(3.0, 1.0, 2.0, 2.0)));
        assert!(rect.holds(&Rect::new(1.0, 2.0, 2.0, 1.0)));
        assert!(!rect.holds(&Rect::new(0.5, 2.0, 1.0, 1.0)));
    }

    #[test]
    fn an_ellipse_touches_the_ends_of_its_axes() {
        let mut path = Path::new();
        path.add_ellipse((10.0, 20.0), (4.0, 1.0), std::f64::consts::FRAC_PI_2);
        // The long axis points down, the short one to the left.
        let expected = [
            (10.0, 24.0),
            (9.0, 20.0),
            (10.0, 16.0),
            (11.0, 20.0),
            (10.0, 24.0),
        ];
        let found = corners(&path);
        assert_eq!(found.len(), expected.len());
        for ((x, y), (ex, ey)) in found.into_iter().zip(expected) {
            // Tolerance for one rotation of small numbers.
            assert!((x - ex).abs() < 1e-12 && (y - ey).abs() < 1e-12, "{x} {y}");
        }
    }

    #[test]
    fn what_ran_to_the_right_runs_up_after_a_quarter_turn() {
        let path = Path::polyline([(2.0, 5.0), (6.0, 5.0), (6.0, 7.0)]).turned_up((2.0, 5.0));
        assert_eq!(corners(&path), [(2.0, 5.0), (2.0, 1.0), (4.0, 1.0)]);
    }
}
