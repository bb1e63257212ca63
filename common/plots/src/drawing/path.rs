//! Outlines of shapes.

use std::fmt::Write;

/// A rectangle along the axes, in pixels.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rect {
    pub x: f64,
    pub y: f64,
    pub width: f64,
    pub height: f64,
}

impl Rect {
    pub const fn new(x: f64, y: f64, width: f64, height: f64) -> Self {
        Rect {
            x,
            y,
            width,
            height,
        }
    }

    pub fn right(&self) -> f64 {
        self.x + self.width
    }

    pub fn bottom(&self) -> f64 {
        self.y + self.height
    }

    pub fn center(&self) -> (f64, f64) {
        (self.x + self.width / 2.0, self.y + self.height / 2.0)
    }

    /// True if both have a common area.
    pub fn overlaps(&self, other: &Rect) -> bool {
        self.x < other.right()
            && other.x < self.right()
            && self.y < other.bottom()
            && other.y < self.bottom()
    }

    /// True if the other rectangle is inside.
    pub fn holds(&self, other: &Rect) -> bool {
        self.x <= other.x
            && self.y <= other.y
            && other.right() <= self.right()
            && other.bottom() <= self.bottom()
    }

    /// Moves each edge inwards by this, or outwards if negative.
    pub fn shrunk(&self, by: f64) -> Self {
        Rect::new(
            self.x + by,
            self.y + by,
            (self.width - 2.0 * by).max(0.0),
            (self.height - 2.0 * by).max(0.0),
        )
    }
}

/// Any number of outlines, as path data of SVG. They are filled by the nonzero rule: an outline
/// inside another is a hole if it has the opposite direction.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Path(String);

impl Path {
    /// Adds a command of SVG with its numbers.
    pub(crate) fn push(&mut self, command: char, numbers: &[f64]) {
        self.0.push(command);
        for (i, &number) in numbers.iter().enumerate() {
            let comma = if i == 0 { "" } else { "," };
            // Writing to a string never fails.
            let _ = write!(self.0, "{comma}{}", rounded(number));
        }
    }

    /// Adds the outlines of another path.
    pub fn add(&mut self, other: &Path) {
        self.0.push_str(&other.0);
    }

    pub fn add_line(&mut self, from: (f64, f64), to: (f64, f64)) {
        self.add(&Path::line(from, to));
    }

    pub fn line(from: (f64, f64), to: (f64, f64)) -> Self {
        Path::polyline([from, to])
    }

    /// An open line through points.
    pub fn polyline(points: impl IntoIterator<Item = (f64, f64)>) -> Self {
        let mut path = Path::default();
        for (i, (x, y)) in points.into_iter().enumerate() {
            path.push(if i == 0 { 'M' } else { 'L' }, &[x, y]);
        }
        path
    }

    pub fn polygon(points: impl IntoIterator<Item = (f64, f64)>) -> Self {
        let mut path = Path::polyline(points);
        path.push('Z', &[]);
        path
    }

    pub fn rect(rect: Rect) -> Self {
        let (right, bottom) = (rect.right(), rect.bottom());
        let (x, y) = (rect.x, rect.y);
        Path::polygon([(x, y), (right, y), (right, bottom), (x, bottom)])
    }

    pub fn circle(center: (f64, f64), radius: f64) -> Self {
        Path::ellipse(center, (radius, radius), 0.0)
    }

    /// An ellipse of two half axes, the first of them turned by `angle` radians from the picture's
    /// x axis towards its y axis, which appears clockwise.
    pub fn ellipse((x, y): (f64, f64), (a, b): (f64, f64), angle: f64) -> Self {
        let (along_x, along_y) = (a * angle.cos(), a * angle.sin());
        let (start, middle) = ((x + along_x, y + along_y), (x - along_x, y - along_y));
        let mut path = Path::default();
        path.push('M', &[start.0, start.1]);
        for (x, y) in [middle, start] {
            path.push('A', &[a, b, angle.to_degrees(), 0.0, 1.0, x, y]);
        }
        path.push('Z', &[]);
        path
    }

    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    pub(crate) fn into_data(self) -> String {
        self.0
    }
}

/// Rounds to a hundredth of a pixel, which keeps files small.
pub(crate) fn rounded(value: f64) -> f32 {
    ((value * 100.0).round() / 100.0) as f32
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rectangles_that_touch_do_not_overlap() {
        let rect = Rect::new(1.0, 1.0, 2.0, 2.0);
        assert!(rect.overlaps(&Rect::new(2.0, 2.0, 5.0, 5.0)));
        assert!(!rect.overlaps(&Rect::new(3.0, 1.0, 2.0, 2.0)));
        assert!(rect.holds(&Rect::new(1.0, 2.0, 2.0, 1.0)));
        assert!(!rect.holds(&Rect::new(0.5, 2.0, 1.0, 1.0)));
    }

    #[test]
    fn an_ellipse_begins_and_turns_back_at_the_ends_of_its_first_axis() {
        let mut path = Path::line((0.0, 0.5), (1.234, -2.0));
        let quarter = std::f64::consts::FRAC_PI_2;
        path.add(&Path::ellipse((10.0, 20.0), (4.0, 1.0), quarter));
        let expected = "M0,0.5L1.23,-2M10,24A4,1,90,0,1,10,16A4,1,90,0,1,10,24Z";
        assert_eq!(path.into_data(), expected);
    }
}
