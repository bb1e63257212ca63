//! Axes, and the bar that says what colours mean, without numbers that would overlap.

use crate::drawing::{Anchor, Color, Path, Rect, Scene, Stroke};

use super::extent::Extent;
use super::scale::Scale;
use super::theme::{self, TEXT};
use super::view::View;

/// Length of ticks, and from their ends to the numbers, pixels of a picture of the common width.
const TICK: f64 = 5.0;
const BESIDE: f64 = 4.0;
const LINE: f64 = 1.25 * TEXT;
/// Room for the name of an upright axis, and from the numbers to its base line.
const NAME: (f64, f64) = (1.4 * TEXT, 0.55 * TEXT);
/// Room below an area for ticks, numbers and the name, and above it for half a number.
const BELOW: f64 = TICK + 2.0 * LINE + 4.0;
const ABOVE: f64 = 9.0;
/// Room at the right, where no number reaches beyond it.
const RIGHT: f64 = 4.0;
/// The least gap between two numbers.
const GAP: f64 = 10.0;
/// From an area to the bar of colours beside it, and how wide that is.
const BAR: (f64, f64) = (16.0, 18.0);

#[derive(Debug, Clone, Copy)]
pub(super) struct Axis<'a> {
    pub(super) scale: Scale,
    /// What is measured, with its unit.
    pub(super) name: &'a str,
}

/// A number beside an axis, and where along it, pixels.
type Number = (f64, String);

impl Axis<'_> {
    /// The numbers beside an axis of a length; `upright` says that it runs up.
    fn numbers(&self, length: f64, upright: bool, unit: f64) -> Vec<Number> {
        let style = theme::text(unit);
        let half = |text: &str| match upright {
            true => LINE * unit / 2.0,
            false => (style.width_of(text) + GAP * unit) / 2.0,
        };
        let at = |(value, text): (f64, String)| (length * self.scale.share(value), text);
        let is_free = |pair: &[Number]| match pair {
            [(low, before), (high, after)] => high - low >= half(before) + half(after),
            _ => true,
        };
        let fits = |numbers: &Vec<Number>| numbers.windows(2).all(is_free);
        let tries = (2..=7).rev().map(|most| {
            let ticks = self.scale.ticks(most);
            ticks.into_iter().map(at).collect()
        });
        let mut all: Vec<Vec<Number>> = tries.collect();
        match all.iter().position(fits) {
            Some(fitting) => all.swap_remove(fitting),
            // One number says at least where the axis is.
            None => all.pop().unwrap_or_default().into_iter().take(1).collect(),
        }
    }

    /// How far the last number below an axis reaches beyond it.
    fn overhang(&self, length: f64, unit: f64) -> f64 {
        let numbers = self.numbers(length, false, unit);
        let reach = |(along, text): &Number| along + theme::text(unit).width_of(text) / 2.0;
        numbers
            .last()
            .map_or(0.0, |last| (reach(last) - length).max(0.0))
    }

    /// How wide the numbers beside an upright axis are.
    fn widest(&self, length: f64, unit: f64) -> f64 {
        let style = theme::text(unit);
        let numbers = self.numbers(length, true, unit);
        let widths = numbers.iter().map(|(_, text)| style.width_of(text));
        widths.fold(0.0, f64::max)
    }
}

/// How high a body must be for an area within axes that is `ratio` times as high as wide.
pub(super) fn height_for(ratio: f64, width: f64, unit: f64) -> f64 {
    // Numbers of three digits: those of others need a little more.
    let beside = (NAME.0 + 4.0 * TEXT * 0.64 + TICK + BESIDE + RIGHT) * unit;
    (ratio * (width - beside) + (ABOVE + BELOW) * unit).round()
}

/// What is left of an area within its axes.
pub(super) fn inside(area: Rect, (x, y): (&Axis<'_>, &Axis<'_>), unit: f64) -> Rect {
    let height = (area.height - (ABOVE + BELOW) * unit).max(1.0);
    let left = y.widest(height, unit) + (NAME.0 + TICK + BESIDE) * unit;
    let width = area.width - left - RIGHT * unit;
    let width = (width - x.overhang(width.max(1.0), unit)).max(1.0);
    Rect::new(area.x + left, area.y + ABOVE * unit, width, height)
}

/// What is left of an area beside a bar of colours, and where that stands.
pub(super) fn beside_bar(area: Rect, axis: &Axis<'_>, unit: f64) -> (Rect, Rect) {
    let height = (area.height - (ABOVE + BELOW) * unit).max(1.0);
    let text = axis.widest(height, unit) + (TICK + BESIDE + NAME.0) * unit;
    let room = (BAR.0 + BAR.1) * unit + text;
    let rest = Rect::new(area.x, area.y, (area.width - room).max(1.0), area.height);
    let left = rest.right() + BAR.0 * unit;
    let bar = Rect::new(left, area.y + ABOVE * unit, BAR.1 * unit, height);
    (rest, bar)
}

/// A view of an extent that fits into an area with its axes.
pub(super) fn view_within(extent: Extent, area: Rect, unit: f64) -> View {
    // How wide the numbers are follows from what is seen, and that from their width.
    let mut view = View::fitting(extent, area);
    for _ in 0..2 {
        let [x, y] = axes_of(&view);
        view = View::fitting(extent, inside(area, (&x, &y), unit));
    }
    view
}

/// The axes of the map around a view, metres.
pub(super) fn draw_metres(scene: &mut Scene, view: &View, unit: f64) {
    let [x, y] = axes_of(view);
    draw(scene, view.area, (x, y), unit);
}

fn axes_of(view: &View) -> [Axis<'static>; 2] {
    let area = view.area;
    let (left, top) = view.metres_at((area.x, area.y));
    let (right, bottom) = view.metres_at((area.right(), area.bottom()));
    let axis = |from, to, name| Axis {
        scale: Scale::Even(from, to),
        name,
    };
    [axis(left, right, "x, m"), axis(bottom, top, "y, m")]
}

/// Draws the frame, ticks, numbers and names of both axes around an area.
pub(super) fn draw(scene: &mut Scene, area: Rect, (x, y): (Axis<'_>, Axis<'_>), unit: f64) {
    let middle = theme::text(unit).anchored(Anchor::Middle);
    let mut ticks = Path::rect(area);
    for (along, text) in x.numbers(area.width, false, unit) {
        let at = area.x + along;
        ticks.add_line((at, area.bottom()), (at, area.bottom() + TICK * unit));
        let below = (at, area.bottom() + (TICK + LINE) * unit);
        scene.text(&text, below, &middle);
    }
    let end = theme::text(unit).anchored(Anchor::End);
    for (along, text) in y.numbers(area.height, true, unit) {
        let at = area.bottom() - along;
        ticks.add_line((area.x - TICK * unit, at), (area.x, at));
        let beside = area.x - (TICK + BESIDE) * unit;
        scene.text(&text, (beside, at + 0.36 * TEXT * unit), &end);
    }
    scene.stroke(ticks, Stroke::new(theme::INK, unit.max(1.0)));
    let below = (area.center().0, area.bottom() + (TICK + 2.0 * LINE) * unit);
    let name = theme::fitted(middle, x.name, area.width);
    scene.text(x.name, below, &name);
    let left = y.widest(area.height, unit) + (TICK + BESIDE + NAME.1) * unit;
    let name = theme::fitted(middle, y.name, area.height);
    scene.text_upwards(y.name, (area.x - left, area.center().1), &name);
}

/// Lines behind a chart at the ticks of both axes.
pub(super) fn draw_grating(scene: &mut Scene, area: Rect, (x, y): (Axis<'_>, Axis<'_>), unit: f64) {
    let mut lines = Path::default();
    for (along, _) in x.numbers(area.width, false, unit) {
        let at = area.x + along;
        lines.add_line((at, area.y), (at, area.bottom()));
    }
    for (along, _) in y.numbers(area.height, true, unit) {
        let at = area.bottom() - along;
        lines.add_line((area.x, at), (area.right(), at));
    }
    scene.stroke(lines, Stroke::new(theme::GRATING, unit));
}

/// Draws a bar of colours, the least value below, with ticks, numbers and its name.
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
    let style = theme::text(unit);
    for (along, text) in axis.numbers(bar.height, true, unit) {
        let at = bar.bottom() - along;
        ticks.add_line((bar.right(), at), (bar.right() + TICK * unit, at));
        let beside = bar.right() + (TICK + BESIDE) * unit;
        scene.text(&text, (beside, at + 0.36 * TEXT * unit), &style);
    }
    scene.stroke(ticks, Stroke::new(theme::INK, unit.max(1.0)));
    let right = axis.widest(bar.height, unit) + (TICK + BESIDE + NAME.0) * unit;
    let at = (bar.right() + right - 0.25 * TEXT * unit, bar.center().1);
    scene.text_upwards(axis.name, at, &style.anchored(Anchor::Middle));
}

#[cfg(test)]
mod tests {
    use super::super::layout;
    use super::*;

    #[test]
    fn labels_of_axes_stand_beside_each_other_within_their_area() {
        let extents = [
            Extent::of([(0.0, 0.0), (95.0, 19.0)]),
            Extent::of([(-0.4, -0.3), (0.5, 0.8)]),
            // As in maps in coordinates of a country.
            Extent::of([(447_000.0, 5_411_000.0), (449_000.0, 5_413_500.0)]),
        ];
        for extent in extents {
            for (width, height) in [(1100.0, 500.0), (260.0, 190.0), (200.0, 130.0)] {
                let area = Rect::new(20.0, 10.0, width, height);
                let mut scene = Scene::new(1200, 600, "").unwrap();
                let view = view_within(extent, area, 1.0);
                draw_metres(&mut scene, &view, 1.0);
                layout::check(&scene);
                let labels = scene.labels();
                assert!(
                    labels.len() >= 4,
                    "two names, and a number each: {labels:?}"
                );
                // A pixel for the view, which begins on whole ones.
                let area = area.shrunk(-1.0);
                assert!(
                    labels.iter().all(|label| area.holds(&label.area)),
                    "{labels:?}"
                );
            }
        }
    }

    #[test]
    fn a_bar_and_its_labels_take_the_room_that_is_left_for_them() {
        for most in [1.0, 36.0, 12_345_678.0] {
            let axis = Axis {
                scale: Scale::Even(0.0, most),
                name: "votes",
            };
            let area = Rect::new(5.0, 5.0, 500.0, 300.0);
            let (rest, bar) = beside_bar(area, &axis, 1.0);
            let mut scene = Scene::new(510, 310, "").unwrap();
            draw_bar(&mut scene, bar, axis, theme::heat, 1.0);
            layout::check(&scene);
            for label in scene.labels() {
                assert!(
                    area.holds(&label.area) && !rest.overlaps(&label.area),
                    "{label:?}"
                );
            }
        }
    }
}
