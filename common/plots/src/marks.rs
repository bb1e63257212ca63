//! Marks of more than one piece: robots, the truth, ellipses, bars and arrows.

use crate::drawing::{Color, Path, Scene, Stroke};
use geometry::{Covariance, ELLIPSE_95, Pose};

use super::shapes::Shape;
use super::theme;
use super::view::View;

/// How much the inside of an ellipse covers.
pub(super) const INSIDE: f32 = 0.12;

/// A point of the picture, and a heading in the map, radians.
pub(super) type Placement = ((f64, f64), f64);

/// Where a pose of the map stands in the picture.
pub(super) fn placement(view: &View, pose: Pose) -> Placement {
    (view.at((pose.x, pose.y)), pose.yaw)
}

/// Draws a robot as a dart, `size` pixels from its middle to its tip.
pub(super) fn robot(scene: &mut Scene, placement: Placement, size: f64, color: Color) {
    let corners = [(1.25, 0.0), (-0.85, 0.8), (-0.45, 0.0), (-0.85, -0.8)];
    let path = Path::polygon(corners.map(|(x, y)| placed(placement, x * size, y * size)));
    scene.stroke(path.clone(), Stroke::new(Color::WHITE, 0.45 * size));
    scene.fill(path, color);
}

/// The true pose as a ring with its heading, in which a robot fits.
pub(super) fn truth(scene: &mut Scene, placement: Placement, size: f64) {
    let mut path = Path::circle(placement.0, size);
    path.add_line(
        placed(placement, size, 0.0),
        placed(placement, 1.9 * size, 0.0),
    );
    scene.stroke(path.clone(), Stroke::new(Color::WHITE, 0.5 * size));
    scene.stroke(path, Stroke::new(theme::TRUTH, 0.22 * size));
}

/// The ellipse of a covariance, and a fan of its heading's spread.
pub(super) fn ellipse(
    scene: &mut Scene,
    view: &View,
    (pose, covariance): (Pose, Covariance),
    stroke: Stroke,
) {
    let ellipse = covariance.ellipse();
    let pixels = |metres: f64| ELLIPSE_95 * metres * view.pixels_per_m;
    let axes = (pixels(ellipse.major_m), pixels(ellipse.minor_m));
    let path = Path::ellipse(view.at((pose.x, pose.y)), axes, -ellipse.angle);
    scene.fill(path.clone(), stroke.color.with_opacity(INSIDE));
    scene.stroke(path, stroke);
}

pub(super) fn ends(
    scene: &mut Scene,
    view: &View,
    ends: impl Iterator<Item = (f64, f64)>,
    (shape, size, color): (Shape, f64, Color),
) {
    let mut path = Path::default();
    for end in ends.filter(|&end| view.shows(end)) {
        path.add(&shape.at(view.at(end), size));
    }
    scene.fill(path, color);
}

/// An upright bar with ends, from a point down.
pub(super) fn bar(scene: &mut Scene, (x, top): (f64, f64), length: f64, stroke: Stroke) {
    let half = 2.5 * stroke.width;
    let mut path = Path::line((x, top), (x, top + length));
    for y in [top, top + length] {
        path.add_line((x - half, y), (x + half, y));
    }
    scene.stroke(path, stroke);
}

/// An arrow that points down at a point.
pub(super) fn arrow_down(scene: &mut Scene, (x, tip): (f64, f64), length: f64, stroke: Stroke) {
    let barb = 2.3 * stroke.width;
    let mut path = Path::line((x, tip - length), (x, tip));
    let barbs = [
        (x - barb, tip - 1.5 * barb),
        (x, tip),
        (x + barb, tip - 1.5 * barb),
    ];
    path.add(&Path::polyline(barbs));
    let rim = Stroke::new(Color::WHITE, 2.3 * stroke.width);
    scene.stroke(path.clone(), rim);
    scene.stroke(path, stroke);
}

/// A point in front of a placement, and to its left, pixels.
fn placed((at, yaw): Placement, ahead: f64, left: f64) -> (f64, f64) {
    let (sin, cos) = yaw.sin_cos();
    // y runs down in the picture.
    (
        at.0 + ahead * cos - left * sin,
        at.1 - ahead * sin - left * cos,
    )
}
