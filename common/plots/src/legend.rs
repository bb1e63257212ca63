//! The legend of a picture: whatever is drawn is named when it is drawn.

use crate::drawing::{Color, Path, Rect, Scene, Stroke, TextStyle};

use super::marks;
use super::shapes::Shape;
use super::theme;

#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Sample {
    Mark(Shape, Color),
    Outline(Shape, Color),
    /// A filled area; pale ones have a rim.
    Area(Color),
    Robot(Color),
    Truth,
    Line(Stroke),
    Curve(Stroke, Shape),
    /// A beam and the mark of its end.
    Beam(Shape, Color),
    /// An upright bar with ends.
    Bar(Stroke),
    /// An arrow that points down.
    Arrow(Stroke),
    Ring(Color),
    Ellipse(Color),
}

/// A sample and what it stands for.
pub(super) type Entry = (Sample, String);

/// What is named below a picture, in the order in which it was added.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct Legend {
    entries: Vec<Entry>,
}

const ROW: f64 = 31.0;
/// From entry to entry.
const GAP: f64 = 26.0;
/// The room that a sample takes, before the words.
const SAMPLE: f64 = 32.0;

impl Legend {
    /// Names what is drawn, once.
    pub(super) fn add(&mut self, sample: Sample, name: impl Into<String>) {
        let name = name.into();
        if self.entries.iter().all(|(_, known)| *known != name) {
            self.entries.push((sample, name));
        }
    }

    /// Says more of an entry that is there.
    pub(super) fn amend(&mut self, name: &str, more: &str) {
        let entry = self.entries.iter_mut().find(|(_, known)| known == name);
        if let Some((_, name)) = entry {
            name.push_str(more);
        }
    }

    #[cfg(test)]
    pub(super) fn names(&self) -> Vec<&str> {
        self.entries.iter().map(|(_, name)| name.as_str()).collect()
    }

    pub(super) fn height(&self, width: f64, unit: f64) -> f64 {
        ROW * unit * self.arranged(width, unit).len() as f64
    }

    /// Draws it from a corner on, to the right and down.
    pub(super) fn draw(&self, scene: &mut Scene, (left, top): (f64, f64), width: f64, unit: f64) {
        let style = theme::text(unit);
        for (row, entries) in self.arranged(width, unit).iter().enumerate() {
            let base = top + ROW * unit * (row as f64 + 0.75);
            for &(x, (sample, name)) in entries {
                let at = (left + x + (SAMPLE / 2.0 - 3.0) * unit, base - 6.5 * unit);
                draw_sample(scene, *sample, at, unit);
                let x = x + SAMPLE * unit;
                let style = theme::fitted(style, name, width - x);
                scene.text(name, (left + x, base), &style);
            }
        }
    }

    /// Entries in rows, each with its distance from the left edge.
    fn arranged(&self, width: f64, unit: f64) -> Vec<Vec<(f64, &Entry)>> {
        let style: TextStyle = theme::text(unit);
        let mut rows: Vec<Vec<(f64, &Entry)>> = Vec::new();
        let mut x = f64::INFINITY;
        for entry in &self.entries {
            let length = SAMPLE * unit + style.width_of(&entry.1);
            if x + length > width {
                rows.push(Vec::new());
                x = 0.0;
            }
            if let Some(row) = rows.last_mut() {
                row.push((x, entry));
            }
            x += length + GAP * unit;
        }
        rows
    }
}

fn draw_sample(scene: &mut Scene, sample: Sample, at: (f64, f64), unit: f64) {
    let half = 10.0 * unit;
    let line = Path::line((at.0 - half, at.1), (at.0 + half, at.1));
    match sample {
        Sample::Mark(shape, color) => scene.fill(shape.at(at, 5.0 * unit), color),
        Sample::Outline(shape, color) => {
            let stroke = Stroke::new(color, 1.4 * unit);
            scene.stroke(shape.at(at, 4.5 * unit), stroke);
        }
        Sample::Area(color) => {
            let side = 14.0 * unit;
            let rect = Rect::new(at.0 - side / 2.0, at.1 - side / 2.0, side, side);
            scene.fill(Path::rect(rect), color);
            scene.stroke(Path::rect(rect), Stroke::new(theme::QUIET, 0.8 * unit));
        }
        Sample::Robot(color) => marks::robot(scene, (at, 0.0), 7.5 * unit, color),
        Sample::Truth => marks::truth(scene, ((at.0 - 3.0 * unit, at.1), 0.0), 6.5 * unit),
        Sample::Line(stroke) => scene.stroke(line, stroke),
        Sample::Curve(stroke, shape) => {
            scene.stroke(line, stroke);
            scene.fill(shape.at(at, 4.5 * unit), stroke.color);
        }
        Sample::Beam(shape, color) => {
            let beam = Path::line((at.0 - half, at.1), at);
            scene.stroke(beam, Stroke::new(color.with_opacity(0.5), 1.2 * unit));
            scene.fill(shape.at(at, 4.5 * unit), color);
        }
        Sample::Bar(stroke) => marks::bar(scene, (at.0, at.1 - 9.0 * unit), 18.0 * unit, stroke),
        Sample::Arrow(stroke) => {
            marks::arrow_down(scene, (at.0, at.1 + 10.0 * unit), 20.0 * unit, stroke);
        }
        Sample::Ring(color) => {
            let ring = Path::circle(at, 7.0 * unit);
            scene.stroke(ring, Stroke::new(color, 2.2 * unit));
        }
        Sample::Ellipse(color) => {
            let path = Path::ellipse(at, (10.0 * unit, 5.0 * unit), 0.0);
            scene.fill(path.clone(), color.with_opacity(marks::INSIDE));
            scene.stroke(path, Stroke::new(color, 1.6 * unit));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn legend(names: &[&str]) -> Legend {
        let mut legend = Legend::default();
        for &name in names {
            legend.add(Sample::Truth, name);
        }
        legend
    }

    #[test]
    fn a_legend_that_is_too_long_goes_on_in_the_next_row() {
        let legend = legend(&["one", "two", "three"]);
        let rows = |width| -> Vec<usize> {
            let rows = legend.arranged(width, 1.0);
            rows.iter().map(Vec::len).collect()
        };
        assert_eq!(rows(1000.0), [3]);
        assert_eq!(rows(170.0), [2, 1]);
        assert_eq!(legend.arranged(170.0, 1.0)[1][0].0, 0.0);
        assert_eq!(Legend::default().height(150.0, 1.0), 0.0);
    }

    #[test]
    fn what_is_drawn_twice_is_named_once() {
        let mut legend = legend(&["hit", "truth", "hit"]);
        legend.amend("hit", " (3)");
        legend.amend("short", " (4)");
        assert_eq!(legend.names(), ["hit (3)", "truth"]);
    }
}
