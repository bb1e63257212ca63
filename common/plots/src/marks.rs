//! What is drawn on a map: robots, the truth, ellipses, and a scale bar.

use drawing::{Anchor, Color, Path, Scene, Stroke, TextStyle};
use geometry::{Covariance, ELLIPSE_95, Pose};

use super::theme;
use super::view::View;

/// A point of the picture, and a heading in the map, radians.
pub(super) type Placement = ((f64, f64), f64);

/// Where a pose of the map stands in the picture.
pub(super) fn placement(view: &View, pose: Pose) -> Placement {
    (view.at((pose.x, pose.y)), pose.yaw)
}

/// A robot as a dart that points where it is headed, `size` pixels from its
/// middle to its tip.
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
    let pixels = |metres: f64| ELLIPSE_95 * metres * view.pixels_per_m();
    let axes = (pixels(ellipse.major_m), pixels(ellipse.minor_m));
    let mut path = Path::new();
    path.add_ellipse(view.at((pose.x, pose.y)), axes, -ellipse.angle);
    scene.fill(path.clone(), stroke.color.with_opacity(0.12));
    scene.stroke(path, stroke);
}

/// A bar of a round length in the lower left corner.
pub(super) fn scale_bar(scene: &mut Scene, view: &View, unit: f64) {
    let area = view.area();
    let metres = round_length(0.22 * area.width / view.pixels_per_m());
    let length = metres * view.pixels_per_m();
    let (left, base) = (area.x + 14.0 * unit, area.bottom() - 14.0 * unit);
    let end = |x: f64| [(x, base - 5.0 * unit), (x, base + 5.0 * unit)];
    let mut bar = Path::line((left, base), (left + length, base));
    for x in [left, left + length] {
        bar.add_polyline(end(x));
    }
    scene.stroke(bar.clone(), Stroke::new(Color::WHITE, 6.0 * unit));
    scene.stroke(bar, Stroke::new(theme::INK, 2.0 * unit));
    let style = TextStyle::new(14.0 * unit, theme::INK)
        .anchored(Anchor::Middle)
        .with_halo(Color::WHITE, 4.0 * unit);
    let at = (left + length / 2.0, base - 9.0 * unit);
    scene.text(&length_text(metres), at, &style);
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

/// The longest of 1, 2, 5, 10 and so on that is not above `metres`.
fn round_length(metres: f64) -> f64 {
    let power = 10f64.powf(metres.log10().floor());
    let factors = [5.0, 2.0, 1.0];
    let fits = factors.into_iter().find(|factor| factor * power <= metres);
    fits.unwrap_or(1.0) * power
}

fn length_text(metres: f64) -> String {
    match metres {
        m if m >= 1000.0 => format!("{} km", m / 1000.0),
        m if m >= 1.0 => format!("{m} m"),
        m => format!("{} cm", (100.0 * m).round()),
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::FRAC_PI_2;

    use super::*;

    #[test]
    fn lengths_of_bars_are_round() {
        for (metres, expected) in [
            (9.99, "5 m"),
            (10.0, "10 m"),
            (0.34, "20 cm"),
            (49.0, "20 m"),
            (2100.0, "2 km"),
        ] {
            assert_eq!(length_text(round_length(metres)), expected);
        }
    }

    #[test]
    fn ahead_of_a_robot_that_faces_up_is_up() {
        let placement = ((10.0, 20.0), FRAC_PI_2);
        let near = |(x, y): (f64, f64), ex: f64, ey: f64| (x - ex).hypot(y - ey) < 1e-12;
        assert!(near(placed(placement, 5.0, 0.0), 10.0, 15.0));
        assert!(near(placed(placement, 0.0, 5.0), 5.0, 20.0));
    }
}
