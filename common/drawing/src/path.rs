//! Outlines of shapes.

/// From the centre of a Bézier curve of a quarter circle to its handles.
const QUARTER: f64 = 0.552_284_749_8;

/// A rectangle along the axes, pixels.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rect {
    /// The left edge.
    pub x: f64,
    /// The upper edge.
    pub y: f64,
    /// To the right edge.
    pub width: f64,
    /// To the lower edge.
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

    /// The right edge.
    #[must_use]
    pub fn right(&self) -> f64 {
        self.x + self.width
    }

    /// The lower edge.
    #[must_use]
    pub fn bottom(&self) -> f64 {
        self.y + self.height
    }

    /// The middle.
    #[must_use]
    pub fn center(&self) -> (f64, f64) {
        (self.x + self.width / 2.0, self.y + self.height / 2.0)
    }

    /// Whether both cover some of the same area.
    #[must_use]
    pub fn overlaps(&self, other: &Rect) -> bool {
        self.x < other.right()
            && other.x < self.right()
            && self.y < other.bottom()
            && other.y < self.bottom()
    }

    /// Whether the other lies within.
    #[must_use]
    pub fn holds(&self, other: &Rect) -> bool {
        self.x <= other.x
            && self.y <= other.y
            && other.right() <= self.right()
            && other.bottom() <= self.bottom()
    }

    /// The rectangle with each edge moved inwards, or outwards by less than 0.
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

/// A piece of an outline; each begins where the one before ended.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Piece {
    Move((f64, f64)),
    Line((f64, f64)),
    /// The handle and the end.
    Quadratic((f64, f64), (f64, f64)),
    /// Both handles and the end.
    Cubic((f64, f64), (f64, f64), (f64, f64)),
    Close,
}

/// Any number of outlines. They are filled by the nonzero rule: an outline within
/// another is a hole where it goes the other way around.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Path {
    pub(crate) pieces: Vec<Piece>,
}

impl Path {
    /// Nothing yet.
    #[must_use]
    pub fn new() -> Self {
        Path::default()
    }

    /// Starts an outline.
    pub fn move_to(&mut self, x: f64, y: f64) {
        self.pieces.push(Piece::Move((x, y)));
    }

    /// Goes on straight.
    pub fn line_to(&mut self, x: f64, y: f64) {
        self.pieces.push(Piece::Line((x, y)));
    }

    /// Closes the outline.
    pub fn close(&mut self) {
        self.pieces.push(Piece::Close);
    }

    /// Adds a straight line.
    pub fn add_line(&mut self, (x0, y0): (f64, f64), (x1, y1): (f64, f64)) {
        self.move_to(x0, y0);
        self.line_to(x1, y1);
    }

    /// Adds an open line through points.
    pub fn add_polyline(&mut self, points: impl IntoIterator<Item = (f64, f64)>) {
        for (i, (x, y)) in points.into_iter().enumerate() {
            match i {
                0 => self.move_to(x, y),
                _ => self.line_to(x, y),
            }
        }
    }

    /// Adds a closed line through points.
    pub fn add_polygon(&mut self, points: impl IntoIterator<Item = (f64, f64)>) {
        self.add_polyline(points);
        self.close();
    }

    /// Adds a rectangle.
    pub fn add_rect(&mut self, rect: Rect) {
        let (right, bottom) = (rect.right(), rect.bottom());
        self.add_polygon([
            (rect.x, rect.y),
            (right, rect.y),
            (right, bottom),
            (rect.x, bottom),
        ]);
    }

    /// Adds a circle.
    pub fn add_circle(&mut self, center: (f64, f64), radius: f64) {
        self.add_ellipse(center, (radius, radius), 0.0);
    }

    /// Adds an ellipse of two half axes, the first of them turned by `angle`
    /// radians from the picture's x axis towards its y axis, which is clockwise
    /// to the eye.
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

    /// A rectangle.
    #[must_use]
    pub fn rect(rect: Rect) -> Self {
        let mut path = Path::new();
        path.add_rect(rect);
        path
    }

    /// A circle.
    #[must_use]
    pub fn circle(center: (f64, f64), radius: f64) -> Self {
        let mut path = Path::new();
        path.add_circle(center, radius);
        path
    }

    /// A straight line.
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

    /// The outlines turned by a quarter about a point, so that what ran to the right
    /// runs up.
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

    /// Whether nothing was added.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.pieces.is_empty()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The points between the pieces.
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
            // One rotation of small numbers.
            assert!((x - ex).abs() < 1e-12 && (y - ey).abs() < 1e-12, "{x} {y}");
        }
    }

    #[test]
    fn what_ran_to_the_right_runs_up_after_a_quarter_turn() {
        let path = Path::polyline([(2.0, 5.0), (6.0, 5.0), (6.0, 7.0)]).turned_up((2.0, 5.0));
        assert_eq!(corners(&path), [(2.0, 5.0), (2.0, 1.0), (4.0, 1.0)]);
    }

    #[test]
    fn a_rectangle_goes_around_its_corners() {
        let path = Path::rect(Rect::new(1.0, 2.0, 3.0, 4.0));
        assert_eq!(
            corners(&path),
            [(1.0, 2.0), (4.0, 2.0), (4.0, 6.0), (1.0, 6.0)]
        );
        assert_eq!(path.pieces.last(), Some(&Piece::Close));
    }
}
