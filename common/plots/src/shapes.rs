//! Shapes of marks, so that none differs from another by its colour alone.

use crate::drawing::Path;

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Shape {
    Circle,
    Square,
    Triangle,
    Diamond,
    /// Lies, as the letter x.
    Cross,
    Down,
    Plus,
}

impl Shape {
    /// All shapes, in the order in which the curves of a chart have them.
    pub(super) const ALL: [Shape; 7] = [
        Shape::Circle,
        Shape::Square,
        Shape::Triangle,
        Shape::Diamond,
        Shape::Cross,
        Shape::Down,
        Shape::Plus,
    ];

    /// The shape around a point; all of a size cover about the same area as a circle.
    pub(super) fn at(self, (x, y): (f64, f64), size: f64) -> Path {
        let polygon = |corners: &[(f64, f64)]| {
            Path::polygon(corners.iter().map(|(u, v)| (x + size * u, y + size * v)))
        };
        match self {
            Shape::Circle => Path::circle((x, y), size),
            Shape::Square => polygon(&[(-0.9, -0.9), (0.9, -0.9), (0.9, 0.9), (-0.9, 0.9)]),
            Shape::Triangle => polygon(&[(0.0, -1.4), (1.3, 0.9), (-1.3, 0.9)]),
            Shape::Down => polygon(&[(0.0, 1.4), (-1.3, -0.9), (1.3, -0.9)]),
            Shape::Diamond => polygon(&[(0.0, -1.4), (1.4, 0.0), (0.0, 1.4), (-1.4, 0.0)]),
            Shape::Plus => polygon(&PLUS),
            Shape::Cross => polygon(&PLUS.map(|(u, v)| (0.71 * (u - v), 0.71 * (u + v)))),
        }
    }
}

/// A cross with arms of a length of 1.3, 0.72 wide.
const PLUS: [(f64, f64); 12] = [
    (-0.36, -1.3),
    (0.36, -1.3),
    (0.36, -0.36),
    (1.3, -0.36),
    (1.3, 0.36),
    (0.36, 0.36),
    (0.36, 1.3),
    (-0.36, 1.3),
    (-0.36, 0.36),
    (-1.3, 0.36),
    (-1.3, -0.36),
    (-0.36, -0.36),
];

#[cfg(test)]
mod tests {
    use crate::drawing::{Color, Scene, to_png};

    use super::*;

    #[test]
    fn shapes_differ_and_cover_about_the_same_area() {
        let pictures = Shape::ALL.map(|shape| {
            let mut scene = Scene::new(60, 60, "").unwrap();
            scene.fill(shape.at((30.0, 30.0), 15.0), Color::rgb(0));
            let png = to_png(&scene).unwrap();
            image::load_from_memory(&png).unwrap().to_luma8()
        });
        for (i, picture) in pictures.iter().enumerate() {
            let dark = picture.pixels().filter(|pixel| pixel.0[0] < 128).count();
            // A circle of 15 pixels covers 707; arms are thinner, corners wider.
            assert!((450..900).contains(&dark), "{:?} {dark}", Shape::ALL[i]);
            let others = pictures.iter().filter(|other| *other == picture).count();
            assert_eq!(others, 1, "{:?}", Shape::ALL[i]);
        }
    }
}
