//! A contact sheet: scans of a whole recording at their places, side by side.

use drawing::{Anchor, Path, Rect, Scene, TextStyle};

use super::page::{self, Heading, Page};
use super::scan::Size;
use super::subject::{Ground, Subject};
use super::{axes, places, theme};
use crate::PlotError;

/// A panel of the sheet: a scan, or why there is none.
#[derive(Debug)]
pub(super) enum Panel {
    Scan(Box<Subject>),
    /// The scan's number, and why it was refused.
    Refused(u64, String),
}

/// The height of a panel as a share of its width, at least and at most.
const HEIGHTS: (f64, f64) = (0.4, 0.75);
const GAP: f64 = 10.0;
const CAPTION: f64 = 28.0;
/// A panel is at least this wide.
const LEAST_WIDTH: f64 = 250.0;
/// Text of captions, and by how much marks are smaller than in a picture of one scan.
const SMALL: f64 = 15.0;
const SMALLER: f64 = 0.85;

/// Draws at least one panel.
///
/// # Errors
/// The picture would be too large.
pub(super) fn draw(
    ground: &Ground<'_>,
    panels: &[Panel],
    bag: &str,
    size: Size,
) -> Result<Scene, PlotError> {
    let unit = page::unit(size.width);
    let most = page::body_width(size.width) / (LEAST_WIDTH * unit);
    let columns = columns_for(panels.len(), most as usize);
    let rows = panels.len().div_ceil(columns);
    let gap = GAP * unit;
    let width = (page::body_width(size.width) - gap * (columns - 1) as f64) / columns as f64;
    let height = axes::height_for(shape(ground, panels, size), width, unit) + CAPTION * unit;
    let body_height = (rows as f64 * (height + gap)).round();
    let mut page = Page::new(size.width, body_height, &heading(panels, bag))?;
    for (i, panel) in panels.iter().enumerate() {
        let x = page.body.x + (i % columns) as f64 * (width + gap);
        let y = page.body.y + (i / columns) as f64 * (height + gap);
        draw_panel(
            &mut page,
            ground,
            (panel, size),
            Rect::new(x, y, width, height),
        )?;
    }
    Ok(page.finish()?)
}

/// The height of all panels as a share of their width: half of them are cut to
/// something flatter, half to something higher.
fn shape(ground: &Ground<'_>, panels: &[Panel], size: Size) -> f64 {
    let ratio = |panel: &Panel| match panel {
        Panel::Scan(subject) => {
            let extent = subject.extent(ground, size.whole);
            Some(extent.height() / extent.width())
        }
        Panel::Refused(..) => None,
    };
    let mut ratios: Vec<f64> = panels.iter().filter_map(ratio).collect();
    ratios.sort_by(f64::total_cmp);
    let middle = ratios.get(ratios.len() / 2).copied();
    middle.unwrap_or_default().clamp(HEIGHTS.0, HEIGHTS.1)
}

/// As many columns as make the sheet a little wider than high, if they are legible.
fn columns_for(panels: usize, most: usize) -> usize {
    let wide = (1.2 * panels as f64).sqrt().ceil() as usize;
    wide.min(most).clamp(1, panels.max(1))
}

fn draw_panel(
    page: &mut Page,
    ground: &Ground<'_>,
    (panel, size): (&Panel, Size),
    area: Rect,
) -> Result<(), PlotError> {
    let unit = page.unit;
    let caption = CAPTION * unit;
    let picture = Rect::new(area.x, area.y + caption, area.width, area.height - caption);
    match panel {
        Panel::Scan(subject) => {
            write_caption(&mut page.scene, subject, (area, caption), unit);
            let extent = subject.extent(ground, size.whole);
            let view = axes::view_within(extent, picture, unit);
            ground.draw(page, &view)?;
            let names = (&mut page.scene, &mut page.legend);
            places::draw(names, &view, subject, SMALLER * unit);
            axes::draw_metres(&mut page.scene, &view, unit);
        }
        Panel::Refused(number, reason) => {
            let style = theme::text(unit);
            let base = area.y + 0.7 * caption;
            page.scene
                .text(&number.to_string(), (area.x, base), &style.bold());
            page.scene.fill(Path::rect(picture), theme::UNKNOWN);
            let text = format!("refused: {reason}");
            let style = theme::fitted(style, &text, 0.94 * picture.width);
            let style = style.anchored(Anchor::Middle);
            page.scene.text(&text, picture.center(), &style);
            page.frame(picture);
        }
    }
    Ok(())
}

/// Number, verdict, and how far off.
fn write_caption(scene: &mut Scene, subject: &Subject, (area, height): (Rect, f64), unit: f64) {
    let base = area.y + 0.7 * height;
    let style = TextStyle::new(SMALL * unit, theme::INK);
    let number = subject.number.to_string();
    scene.text(&number, (area.x, base), &style.bold());
    let mut x = area.x + style.bold().width_of(&number) + 8.0 * unit;
    x += page::chip(scene, subject.places.verdict, (x, base), SMALL * unit) + 7.0 * unit;
    let mut words = Vec::new();
    if let Some(best) = subject.shown.first() {
        words.push(format!("{:.2}", best.place.score));
    }
    if let Some((metres, _)) = subject.truth.as_ref().and_then(|truth| truth.off) {
        words.push(match metres {
            m if m < 1.0 => format!("{:.1} cm off", 100.0 * m),
            m => format!("{m:.1} m off"),
        });
    }
    let color = match subject.missed_truth() {
        Some(_) => theme::TRUTH,
        None => theme::INK,
    };
    let text = words.join(", ");
    let style = theme::fitted(TextStyle { color, ..style }, &text, area.right() - x);
    scene.text(&text, (x, base), &style);
}

fn heading(panels: &[Panel], bag: &str) -> Heading {
    let mut judged = 0;
    let mut met = 0;
    for panel in panels {
        if let Panel::Scan(subject) = panel
            && let Some(truth) = &subject.truth
        {
            judged += 1;
            met += usize::from(truth.is_met());
        }
    }
    let says = match judged {
        0 => "each with its verdict and score".to_owned(),
        _ => format!("each with its verdict and score; {met} of {judged} with a truth are at it"),
    };
    Heading {
        title: format!("{bag} · {} scans at their best places", panels.len()),
        verdict: None,
        says,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn panels_fill_rows_that_are_a_little_wider_than_high() {
        for (panels, columns) in [(1, 1), (2, 2), (3, 2), (4, 3), (12, 4), (64, 9)] {
            assert_eq!(columns_for(panels, 9), columns, "{panels}");
        }
        assert_eq!(columns_for(12, 2), 2);
        assert_eq!(columns_for(12, 0), 1);
    }
}
