//! Axes around a part of a picture, and the bar that says what colours mean.

use drawing::{Anchor, Color, Path, Rect, Scene, Stroke, TextStyle};

use super::scale::Scale;
use super::theme;
use super::view::View;

/// Room for the numbers and the name of the axis at the left and at the lower edge,
/// pixels of a picture of the common width.
const LEFT: f64 = 66.0;
const BELOW: f64 = 46.0;
/// Room for a bar of colours at the right edge.
const BAR: f64 = 92.0;
/// Text of the numbers, and how long the ticks are.
const NUMBERS: f64 = 13.0;
const TICK: f64 = 5.0;

/// What an axis says.
#[derive(Debug, Clone, Copy)]
pub(super) struct Axis<'a> {
    pub(super) scale: Scale,
    /// What is measured, with its unit.
    pub(super) name: &'a str,
}

/// What is left of an area within its axes.
pub(super) fn inside(area: Rect, unit: f64) -> Rect {
    let left = LEFT * unit;
    let top = 6.0 * unit;
    Rect::new(
        area.x + left,
        area.y + top,
        (area.width - left - 8.0 * unit).max(1.0),
        (area.height - BELOW * unit - top).max(1.0),
    )
}

/// What is left of an area beside a bar of colours, and where that stands.
pub(super) fn beside_bar(area: Rect, unit: f64) -> (Rect, Rect) {
    let room = BAR * unit;
    let rest = Rect::new(area.x, area.y, (area.width - room).max(1.0), area.height);
    let bar = Rect::new(
        rest.right() + 14.0 * unit,
        area.y + 6.0 * unit,
        18.0 * unit,
        (area.height - BELOW * unit - 6.0 * unit).max(1.0),
    );
    (rest, bar)
}

/// The axes of the map around a view, metres.
pub(super) fn draw_metres(scene: &mut Scene, view: &View, unit: f64) {
    let area = view.area();
    let (left, top) = view.metres_at((area.x, area.y));
    let (right, bottom) = view.metres_at((area.right(), area.bottom()));
    let x = Axis {
        scale: Scale::Even(left, right),
        name: "x, m",
    };
    let y = Axis {
        scale: Scale::Even(bottom, top),
        name: "y, m",
    };
    draw(scene, area, (x, y), unit);
}

/// Draws the frame, ticks, numbers and names of both axes around an area.
pub(super) fn draw(scene: &mut Scene, area: Rect, (x, y): (Axis<'_>, Axis<'_>), unit: f64) {
    let style = TextStyle::new(NUMBERS * unit, theme::INK);
    let mut ticks = Path::rect(area);
    for (value, text) in x.scale.ticks() {
        let at = area.x + area.width * x.scale.share(value);
        ticks.add_line((at, area.bottom()), (at, area.bottom() + TICK * unit));
        let below = (at, area.bottom() + (TICK + NUMBERS + 1.0) * unit);
        scene.text(&text, below, &style.anchored(Anchor::Middle));
    }
    for (value, text) in y.scale.ticks() {
        let at = area.bottom() - area.height * y.scale.share(value);
        ticks.add_line((area.x - TICK * unit, at), (area.x, at));
        let beside = (area.x - (TICK + 3.0) * unit, at + 0.36 * NUMBERS * unit);
        scene.text(&text, beside, &style.anchored(Anchor::End));
    }
    scene.stroke(ticks, Stroke::new(theme::INK, unit.max(1.0)));
    let style = TextStyle::new(14.0 * unit, theme::INK);
    let below = (area.center().0, area.bottom() + 37.0 * unit);
    scene.text(x.name, below, &style.anchored(Anchor::Middle));
    let beside = (area.x - 52.0 * unit, area.center().1);
    scene.text_upwards(y.name, beside, &style.anchored(Anchor::Middle));
}

/// Lines behind a chart at the ticks of both axes.
pub(super) fn draw_grating(scene: &mut Scene, area: Rect, (x, y): (Scale, Scale), unit: f64) {
    let mut lines = Path::new();
    for (value, _) in x.ticks() {
        let at = area.x + area.width * x.share(value);
        lines.add_line((at, area.y), (at, area.bottom()));
    }
    for (value, _) in y.ticks() {
        let at = area.bottom() - area.height * y.share(value);
        lines.add_line((area.x, at), (area.right(), at));
    }
    scene.stroke(lines, Stroke::new(theme::GRATING, unit));
}

/// Draws a bar of colours, the least value below, with ticks, numbers and the name of
/// what they are of.
pub(super) fn draw_bar(
    scene: &mut Scene,
    bar: Rect,
    axis: Axis<'_>,
    color: fn(f64) -> Color,
    unit: f64,
) {
    let steps = 64;
    let height = bar.height / f64::from(steps);
    for step in 0..steps {
        let y = bar.bottom() - f64::from(step + 1) * height;
        // A little higher, so that no gap shows between them.
        let rect = Rect::new(bar.x, y, bar.width, height + 0.5);
        let share = f64::from(step) / f64::from(steps - 1);
        scene.fill(Path::rect(rect), color(share));
    }
    let mut ticks = Path::rect(bar);
    let style = TextStyle::new(NUMBERS * unit, theme::INK);
    for (value, text) in axis.scale.ticks() {
        let at = bar.bottom() - bar.height * axis.scale.share(value);
        ticks.add_line((bar.right(), at), (bar.right() + TICK * unit, at));
        let beside = (
            bar.right() + (TICK + 3.0) * unit,
            at + 0.36 * NUMBERS * unit,
        );
        scene.text(&text, beside, &style);
    }
    scene.stroke(ticks, Stroke::new(theme::INK, unit.max(1.0)));
    let style = TextStyle::new(14.0 * unit, theme::INK).anchored(Anchor::Middle);
    let below = (bar.center().0, bar.bottom() + 20.0 * unit);
    scene.text(axis.name, below, &style);
}
