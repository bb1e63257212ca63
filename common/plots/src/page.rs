//! What surrounds every picture: a title, what it says, and a legend.

use crate::drawing::{Anchor, Path, Rect, Scene, TextStyle};
use messages::Verdict;

use super::extent::Extent;
use super::legend::Legend;
use super::view::View;
use super::{axes, theme};

/// Pictures are this wide unless somebody asks for another width.
pub(super) const COMMON_WIDTH: u32 = 1200;
/// All lengths are meant for a picture this wide.
const WIDTH: f64 = COMMON_WIDTH as f64;
/// A smaller picture is meant for less paper, on which text must stay legible: its lengths
/// shrink by less. A larger one is the same with more pixels.
const SHRINKING: f64 = 0.3;

#[derive(Debug, Clone, PartialEq)]
pub(super) struct Heading {
    pub(super) title: String,
    /// The verdict on it, if there is one.
    pub(super) verdict: Option<Verdict>,
    pub(super) says: String,
}

impl Heading {
    pub(super) fn plain(title: impl Into<String>, says: impl Into<String>) -> Self {
        Heading {
            title: title.into(),
            verdict: None,
            says: says.into(),
        }
    }
}

/// A picture in the making. What is drawn is named in the legend, which is written last.
#[derive(Debug)]
pub(super) struct Page {
    pub(super) scene: Scene,
    pub(super) legend: Legend,
    /// What is left for the picture itself.
    pub(super) body: Rect,
    /// The picture's pixels for each that a length was meant for.
    pub(super) unit: f64,
}

/// How lengths grow in a picture of this width.
pub(super) fn unit(width: u32) -> f64 {
    let ratio = f64::from(width) / WIDTH;
    if ratio < 1.0 {
        ratio.powf(SHRINKING)
    } else {
        ratio
    }
}

pub(super) fn body_width(width: u32) -> f64 {
    f64::from(width) - 2.0 * MARGIN * unit(width)
}

const MARGIN: f64 = 16.0;
/// The base line of the title, and of the first line below it.
const TITLE_BASE: f64 = 32.0;
const SAYS_BASE: f64 = 61.0;
const LINE: f64 = 25.0;
/// From the last base line to the body.
const BELOW_SAYS: f64 = 16.0;
/// The least of a line's size that is still shrunk to fit; what is longer is broken.
const LEAST_SIZE: f64 = 0.85;

impl Page {
    /// A picture of this many pixels along x, whose body takes this many along y.
    pub(super) fn new(width: u32, body_height: f64, heading: &Heading) -> anyhow::Result<Self> {
        let unit = unit(width);
        let body_width = body_width(width);
        let before = chip_width(heading.verdict, unit);
        let lines = broken(&heading.says, (before, body_width), unit);
        let below = LINE * lines.len().saturating_sub(1) as f64;
        let top = (SAYS_BASE + below + BELOW_SAYS) * unit;
        let body = Rect::new(MARGIN * unit, top, body_width, body_height);
        let title = format!("{}: {}", heading.title, heading.says);
        // Until the legend is known.
        let height = body.bottom().round() as u32;
        let mut page = Page {
            scene: Scene::new(width, height, title)?,
            legend: Legend::default(),
            body,
            unit,
        };
        page.write_heading(heading, &lines);
        Ok(page)
    }

    /// A picture of a part of the map, with a body `lowest..=highest` times as high as wide.
    pub(super) fn of_map(
        width: u32,
        extent: Extent,
        (lowest, highest): (f64, f64),
        heading: &Heading,
    ) -> anyhow::Result<(Self, View)> {
        let ratio = (extent.height() / extent.width()).clamp(lowest, highest);
        let height = axes::height_for(ratio, body_width(width), unit(width));
        let page = Page::new(width, height, heading)?;
        let view = axes::view_within(extent, page.body, page.unit);
        Ok((page, view))
    }

    fn write_heading(&mut self, heading: &Heading, lines: &[String]) {
        let unit = self.unit;
        let left = self.body.x;
        let style = theme::title(unit);
        let title = shortened(&heading.title, self.body.width / LEAST_SIZE, unit);
        let style = theme::fitted(style, &title, self.body.width);
        self.scene.text(&title, (left, TITLE_BASE * unit), &style);
        let base = SAYS_BASE * unit;
        if let Some(verdict) = heading.verdict {
            chip(&mut self.scene, verdict, (left, base), theme::TEXT * unit);
        }
        let before = chip_width(heading.verdict, unit);
        for (i, line) in lines.iter().enumerate() {
            let x = if i == 0 { before } else { 0.0 };
            let style = theme::fitted(theme::text(unit), line, self.body.width - x);
            let at = (left + x, base + LINE * unit * i as f64);
            self.scene.text(line, at, &style);
        }
    }

    /// The picture, with its legend below.
    pub(super) fn finish(mut self) -> anyhow::Result<Scene> {
        let (unit, body) = (self.unit, self.body);
        let below = self.legend.height(body.width, unit) + MARGIN * unit;
        let bottom = body.bottom() + below;
        self.scene.set_height(bottom.round() as u32)?;
        let corner = (body.x, body.bottom());
        self.legend.draw(&mut self.scene, corner, body.width, unit);
        Ok(self.scene)
    }
}

/// Breaks a sentence into lines of a width, the first of which begins at `before`.
fn broken(text: &str, (before, width): (f64, f64), unit: f64) -> Vec<String> {
    let style = theme::text(unit);
    if style.width_of(text) * LEAST_SIZE <= width - before {
        return vec![text.to_owned()];
    }
    let mut lines = vec![String::new()];
    for word in text.split(' ') {
        let room = width - if lines.len() == 1 { before } else { 0.0 };
        match lines.last_mut() {
            Some(line) if line.is_empty() => line.push_str(word),
            Some(line) if style.width_of(&format!("{line} {word}")) <= room => {
                *line += &format!(" {word}");
            }
            _ => lines.push(word.to_owned()),
        }
    }
    lines
}

/// The end of a title that fits: files differ in the ends of their paths.
fn shortened(title: &str, width: f64, unit: f64) -> String {
    let style = theme::title(unit);
    if style.width_of(title) <= width {
        return title.to_owned();
    }
    let ends = |is_begin: fn(char) -> bool| {
        let begins = title
            .char_indices()
            .filter(move |&(_, letter)| is_begin(letter));
        begins.map(|(at, _)| format!("…{}", title.split_at(at).1))
    };
    let mut ends = ends(|letter| letter == '/').chain(ends(|_| true));
    ends.find(|end| style.width_of(end) <= width)
        .unwrap_or_default()
}

/// Writes a verdict on a plate of its colour at a point of the base line; returns its width.
pub(super) fn chip(scene: &mut Scene, verdict: Verdict, (x, base): (f64, f64), size: f64) -> f64 {
    let (color, _) = theme::of_verdict(verdict);
    let ink = theme::ink_on(color);
    let style = TextStyle::new(size, ink).bold();
    let width = style.width_of(verdict.as_str()) + size;
    let plate = Rect::new(x, base - 1.06 * size, width, 1.4 * size);
    scene.fill(Path::rect(plate), color);
    let at = (x + width / 2.0, base);
    scene.text(verdict.as_str(), at, &style.anchored(Anchor::Middle));
    width
}

/// How much of the first line a verdict takes.
fn chip_width(verdict: Option<Verdict>, unit: f64) -> f64 {
    let size = theme::TEXT * unit;
    let style = theme::text(unit).bold();
    verdict.map_or(0.0, |verdict| style.width_of(verdict.as_str()) + 1.6 * size)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn heading(says: &str) -> Heading {
        Heading {
            title: "a folder/of some/recordings/that are/far down/recording.mcap · scan 7".into(),
            verdict: Some(Verdict::Unique),
            says: says.into(),
        }
    }

    #[test]
    fn text_that_is_too_long_is_broken_or_loses_its_beginning() {
        let says = "one place, fit 0.90 · 3.4 cm and 0.06° from the truth · and more of it";
        let page = Page::new(300, 100.0, &heading(says)).unwrap();
        let labels = page.scene.labels();
        assert!(labels[0].text.starts_with("…/") && labels[0].text.ends_with("scan 7"));
        let lines: Vec<&str> = labels[2..].iter().map(|label| &*label.text).collect();
        assert!(lines.len() > 1, "{lines:?}");
        assert_eq!(lines.join(" "), says);
        let picture = page.scene.area();
        for (i, label) in labels.iter().enumerate() {
            assert!(picture.holds(&label.area), "{label:?}");
            let mut others = labels[i + 1..].iter();
            assert!(
                others.all(|other| !other.area.overlaps(&label.area)),
                "{label:?}"
            );
        }
        let wide = Page::new(1200, 100.0, &heading("short")).unwrap();
        assert_eq!(wide.scene.labels().len(), 3);
        assert!(wide.body.y < page.body.y / unit(300), "a line is saved");
    }

    #[test]
    fn text_of_a_small_picture_is_larger_in_it() {
        let share = |width: u32| unit(width) / f64::from(width);
        assert!(share(600) > 1.5 * share(1200));
        // A rounding of the division.
        assert!((share(4000) - share(1200)).abs() < 1e-12);
    }
}
