//! What surrounds every picture: a title, what it says, and a legend.

use drawing::{Anchor, Color, DrawingError, Path, Rect, Scene, Stroke, TextStyle};
use messages::Verdict;

use super::theme;

/// Pictures are this wide unless somebody asks for another width.
pub(super) const COMMON_WIDTH: u32 = 1200;
/// All lengths are meant for a picture this wide.
const WIDTH: f64 = COMMON_WIDTH as f64;
/// They grow with the width, but by less, so that a small picture is legible.
const GROWTH: f64 = 0.7;

/// The lines above a picture.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Heading {
    /// What is shown.
    pub(super) title: String,
    /// The verdict on it, if there is one.
    pub(super) verdict: Option<Verdict>,
    /// A sentence about it.
    pub(super) says: String,
}

/// What an entry of the legend looks like.
#[derive(Debug, Clone, Copy)]
pub(super) enum Sample {
    /// A dot.
    Dot(Color),
    /// A square.
    Square(Color),
    /// A robot.
    Robot(Color),
    /// The mark of the truth.
    Truth,
    /// A line.
    Line(Stroke),
    /// An ellipse.
    Ellipse(Color),
}

/// An entry of the legend.
pub(super) type Entry = (Sample, String);

/// A picture with all but its body.
#[derive(Debug)]
pub(super) struct Page {
    pub(super) scene: Scene,
    /// What is left for the picture itself.
    pub(super) body: Rect,
    /// The picture's pixels for each that a length was meant for.
    pub(super) unit: f64,
}

/// How lengths grow in a picture of this width.
pub(super) fn unit(width: u32) -> f64 {
    (f64::from(width) / WIDTH).powf(GROWTH)
}

/// How wide the body of a picture is, in pixels.
pub(super) fn body_width(width: u32) -> f64 {
    f64::from(width) - 2.0 * MARGIN * unit(width)
}

const MARGIN: f64 = 16.0;
const HEADING: f64 = 68.0;
const LEGEND_ROW: f64 = 30.0;
/// From entry to entry of the legend.
const ENTRY_GAP: f64 = 26.0;
/// The room that a sample takes, before the words.
const SAMPLE: f64 = 30.0;

impl Page {
    /// A picture of this many pixels along x, whose body takes this many along y.
    pub(super) fn new(
        width: u32,
        body_height: f64,
        heading: &Heading,
        legend: &[Entry],
    ) -> Result<Self, DrawingError> {
        let unit = unit(width);
        let rows = arranged(legend, body_width(width), unit);
        let legend_height = LEGEND_ROW * unit * rows.len() as f64;
        let body = Rect::new(
            MARGIN * unit,
            HEADING * unit,
            body_width(width),
            body_height,
        );
        let bottom = body.bottom() + legend_height + MARGIN * unit;
        let title = format!("{}: {}", heading.title, heading.says);
        let mut page = Page {
            scene: Scene::new(width, bottom.round() as u32, title, Color::WHITE)?,
            body,
            unit,
        };
        page.write_heading(heading);
        for (row, entries) in rows.iter().enumerate() {
            let y = body.bottom() + LEGEND_ROW * unit * (row as f64 + 0.72);
            page.write_entries(entries, y);
        }
        Ok(page)
    }

    fn write_heading(&mut self, heading: &Heading) {
        let unit = self.unit;
        let left = self.body.x;
        let title = TextStyle::new(21.0 * unit, theme::INK).bold();
        let title = fitted(title, &heading.title, self.body.width);
        self.scene.text(&heading.title, (left, 29.0 * unit), &title);
        let base = 54.0 * unit;
        let mut x = left;
        if let Some(verdict) = heading.verdict {
            x += chip(&mut self.scene, verdict, (x, base), 15.0 * unit) + 10.0 * unit;
        }
        let says = TextStyle::new(16.0 * unit, theme::INK);
        let says = fitted(says, &heading.says, self.body.right() - x);
        self.scene.text(&heading.says, (x, base), &says);
    }

    fn write_entries(&mut self, entries: &[(f64, &Entry)], base: f64) {
        let unit = self.unit;
        let style = TextStyle::new(14.0 * unit, theme::INK);
        for &(x, (sample, name)) in entries {
            let x = self.body.x + x;
            let at = (x + (SAMPLE / 2.0 - 3.0) * unit, base - 5.0 * unit);
            let width = draw_sample(&mut self.scene, *sample, at, unit);
            self.scene.text(name, (x + width, base), &style);
        }
    }

    /// A frame around a part of the picture.
    pub(super) fn frame(&mut self, area: Rect) {
        let stroke = Stroke::new(theme::FRAME, self.unit.max(1.0));
        self.scene.stroke(Path::rect(area.shrunk(0.5)), stroke);
    }
}

/// Entries in rows, each with its distance from the left edge.
fn arranged(legend: &[Entry], width: f64, unit: f64) -> Vec<Vec<(f64, &Entry)>> {
    let style = TextStyle::new(14.0 * unit, theme::INK);
    let mut rows: Vec<Vec<(f64, &Entry)>> = Vec::new();
    let mut x = f64::INFINITY;
    for entry in legend {
        let length = SAMPLE * unit + style.width_of(&entry.1);
        if x + length > width {
            rows.push(Vec::new());
            x = 0.0;
        }
        if let Some(row) = rows.last_mut() {
            row.push((x, entry));
        }
        x += length + ENTRY_GAP * unit;
    }
    rows
}

/// Draws a sample around a point; returns how much room it takes from the left.
fn draw_sample(scene: &mut Scene, sample: Sample, at: (f64, f64), unit: f64) -> f64 {
    use super::marks;
    match sample {
        Sample::Dot(color) => scene.fill(Path::circle(at, 5.0 * unit), color),
        Sample::Square(color) => {
            let side = 13.0 * unit;
            let rect = Rect::new(at.0 - side / 2.0, at.1 - side / 2.0, side, side);
            scene.fill(Path::rect(rect), color);
        }
        Sample::Robot(color) => marks::robot(scene, (at, 0.0), 7.0 * unit, color),
        Sample::Truth => {
            let ring = (at.0 - 3.0 * unit, at.1);
            marks::truth(scene, (ring, 0.0), 6.5 * unit);
        }
        Sample::Line(stroke) => {
            let half = 9.0 * unit;
            let line = Path::line((at.0 - half, at.1), (at.0 + half, at.1));
            scene.stroke(line, stroke);
        }
        Sample::Ellipse(color) => {
            let mut path = Path::new();
            path.add_ellipse(at, (9.0 * unit, 4.5 * unit), 0.0);
            scene.stroke(path, Stroke::new(color, 1.6 * unit));
        }
    }
    SAMPLE * unit
}

/// Writes a verdict on a plate of its colour that starts at a point of the base
/// line; returns how wide it is.
pub(super) fn chip(scene: &mut Scene, verdict: Verdict, (x, base): (f64, f64), size: f64) -> f64 {
    let style = TextStyle::new(size, Color::WHITE).bold();
    let width = style.width_of(verdict.as_str()) + 1.1 * size;
    let plate = Rect::new(x, base - 1.08 * size, width, 1.46 * size);
    scene.fill(Path::rect(plate), theme::of_verdict(verdict));
    let at = (x + width / 2.0, base);
    scene.text(verdict.as_str(), at, &style.anchored(Anchor::Middle));
    width
}

/// The style, smaller where the text would be wider than `width`.
pub(super) fn fitted(style: TextStyle, text: &str, width: f64) -> TextStyle {
    let natural = style.width_of(text);
    TextStyle {
        size: style.size * (width / natural.max(1.0)).min(1.0),
        ..style
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_legend_that_is_too_long_goes_on_in_the_next_row() {
        let entry = |name: &str| (Sample::Dot(theme::INK), name.to_owned());
        let legend = [entry("one"), entry("two"), entry("three")];
        let all = arranged(&legend, 1000.0, 1.0);
        assert_eq!(all.iter().map(Vec::len).collect::<Vec<_>>(), [3]);
        let split = arranged(&legend, 150.0, 1.0);
        assert_eq!(split.iter().map(Vec::len).collect::<Vec<_>>(), [2, 1]);
        assert_eq!(split[1][0].0, 0.0);
        assert!(arranged(&[], 150.0, 1.0).is_empty());
    }

    #[test]
    fn long_text_is_written_smaller() {
        let style = TextStyle::new(20.0, theme::INK);
        let text = "a sentence that is longer than the picture";
        let small = fitted(style, text, 100.0);
        // Widths are proportional to the size.
        assert!((small.width_of(text) - 100.0).abs() < 1e-9);
        assert_eq!(fitted(style, "x", 100.0), style);
    }

    #[test]
    fn the_body_has_the_size_that_was_asked_for() {
        let heading = Heading {
            title: "a map".into(),
            verdict: Some(Verdict::Unique),
            says: "one place, fit 0.90".into(),
        };
        let legend = [(Sample::Truth, "truth".into())];
        let page = Page::new(600, 321.0, &heading, &legend).unwrap();
        assert_eq!(page.body.height, 321.0);
        assert_eq!(page.body.width, body_width(600));
        let below = f64::from(page.scene.height()) - page.body.bottom();
        // A row and the margin, to a whole pixel.
        let expected = unit(600) * (LEGEND_ROW + MARGIN);
        assert!((below - expected).abs() <= 0.5, "{below} {expected}");
    }
}
