//! Picture of a drive: how far off the best place of each scan is, and its verdict.

use crate::drawing::{Path, Rect, Scene, Stroke};
use answers::statistics::SUCCESS;
use messages::Verdict;

use super::axes::{self, Axis};
use super::legend::{Legend, Sample};
use super::page::{self, Heading, Page};
use super::scale::Scale;
use super::shapes::Shape;
use super::theme;

#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Judged {
    /// When it was measured, nanoseconds since 1970.
    pub(super) stamp_ns: i64,
    pub(super) verdict: Verdict,
    /// Metres and degrees from the best place to the true one; `None` without a place.
    pub(super) off: Option<(f64, f64)>,
}

impl Judged {
    fn is_found(&self) -> bool {
        let (most_m, most_deg) = SUCCESS;
        self.off
            .is_some_and(|(metres, degrees)| metres <= most_m && degrees <= most_deg)
    }
}

/// The height of each chart as a share of the width.
const HEIGHT: f64 = 0.24;
const MARK: f64 = 4.2;

/// Draws the picture of at least one judged scan.
pub(super) fn draw(judged: &[Judged], bag: &str, width: u32) -> anyhow::Result<Scene> {
    let unit = page::unit(width);
    let one = axes::height_for(HEIGHT, page::body_width(width), unit);
    let mut page = Page::new(width, 2.0 * one, &heading(judged, bag))?;
    let body = page.body;
    name(&mut page.legend, judged, unit);
    let areas = [0.0, 1.0].map(|i| Rect::new(body.x, body.y + one * i, body.width, one));
    let parts = SERIES.iter().zip(areas).map(|(series, area)| {
        let [time, error] = series.axes(judged);
        (series, axes::inside(area, (&time, &error), unit))
    });
    // Both times run side by side.
    let left = parts.clone().map(|(_, area)| area.x).fold(0.0, f64::max);
    let rights = parts.clone().map(|(_, area)| area.right());
    let right = rights.fold(f64::MAX, f64::min);
    for (series, area) in parts {
        let area = Rect::new(left, area.y, right - left, area.height);
        series.draw(&mut page, judged, area);
    }
    page.finish()
}

struct Series {
    name: &'static str,
    limit: f64,
    /// The least that an axis goes down to: what a truth is good for.
    least: f64,
    value: fn((f64, f64)) -> f64,
}

const SERIES: [Series; 2] = [
    Series {
        name: "position error, m",
        limit: SUCCESS.0,
        least: 0.001,
        value: |(metres, _)| metres,
    },
    Series {
        name: "heading error, °",
        limit: SUCCESS.1,
        least: 0.01,
        value: |(_, degrees)| degrees,
    },
];

impl Series {
    fn axes(&self, judged: &[Judged]) -> [Axis<'static>; 2] {
        // Beside the first and the last scan is some room.
        let duration = duration_s(judged).max(1e-3);
        let time = Axis {
            scale: Scale::Even(-0.015 * duration, 1.015 * duration),
            name: "time, s",
        };
        let error = Axis {
            scale: self.scale(judged),
            name: self.name,
        };
        [time, error]
    }

    fn draw(&self, page: &mut Page, judged: &[Judged], area: Rect) {
        let unit = page.unit;
        let [time, error] = self.axes(judged);
        let scale = error.scale;
        axes::draw_grating(&mut page.scene, area, (time, error), unit);
        let height = |value: f64| area.bottom() - area.height * scale.share(value);
        let y = height(self.limit);
        let line = Path::line((area.x, y), (area.right(), y));
        page.scene.stroke(line, limit_stroke(unit));
        for verdict in theme::VERDICTS {
            let scans = judged.iter().filter(|scan| scan.verdict == verdict);
            let at = |scan: &Judged| {
                let x = area.x + area.width * time.scale.share(seconds(judged, scan));
                let value = scan.off.map(self.value);
                // What has no place stands at the top.
                let y = value.map_or(area.y, height);
                let shape = match value {
                    None => Some(Shape::Cross),
                    Some(value) => scale.is_below(value).then_some(Shape::Down),
                };
                ((x, y), shape)
            };
            draw_marks(page, verdict, scans.map(at));
        }
        axes::draw(&mut page.scene, area, (time, error), unit);
    }

    /// Of decades, from what a truth is good for to beyond the limit at least.
    fn scale(&self, judged: &[Judged]) -> Scale {
        let values = judged.iter().filter_map(|judged| judged.off);
        let values = values.map(|off| (self.value)(off).max(self.least));
        let around = [self.limit, 1.5 * self.limit];
        Scale::of_decades(values.chain(around))
    }
}

/// Draws the marks of a verdict, and names those without a place or below the axis.
fn draw_marks(
    page: &mut Page,
    verdict: Verdict,
    marks: impl Iterator<Item = ((f64, f64), Option<Shape>)>,
) {
    let (color, common) = theme::of_verdict(verdict);
    let (mut filled, mut outlined) = (Path::default(), Path::default());
    for (at, shape) in marks {
        let size = MARK * page.unit;
        match shape {
            None => filled.add(&common.at(at, size)),
            Some(Shape::Down) => {
                outlined.add(&Shape::Down.at(at, size));
                let name = format!("below the axis: less than {} m or {}°", LEAST.0, LEAST.1);
                page.legend.add(BELOW, name);
            }
            Some(other) => {
                filled.add(&other.at(at, size));
                page.legend.add(NOWHERE, "no place, so no error");
            }
        }
    }
    page.scene.fill(filled, color.with_opacity(0.85));
    let outline = Stroke::new(color, 1.4 * page.unit);
    page.scene.stroke(outlined, outline);
}

const LEAST: (f64, f64) = (SERIES[0].least, SERIES[1].least);
const BELOW: Sample = Sample::Outline(Shape::Down, theme::INK);
const NOWHERE: Sample = Sample::Mark(Shape::Cross, theme::INK);

fn limit_stroke(unit: f64) -> Stroke {
    Stroke {
        dash: 6.0 * unit,
        ..Stroke::new(theme::QUIET, 1.4 * unit)
    }
}

/// Seconds from the first scan to another.
fn seconds(judged: &[Judged], scan: &Judged) -> f64 {
    let first = judged.iter().map(|judged| judged.stamp_ns).min();
    // Stamps come from files: their difference may be anything.
    scan.stamp_ns.saturating_sub(first.unwrap_or_default()) as f64 / 1e9
}

fn duration_s(judged: &[Judged]) -> f64 {
    let all = judged.iter().map(|scan| seconds(judged, scan));
    all.fold(0.0, f64::max)
}

fn heading(judged: &[Judged], bag: &str) -> Heading {
    let found = judged.iter().filter(|judged| judged.is_found()).count();
    let unique = judged
        .iter()
        .filter(|judged| judged.verdict == Verdict::Unique);
    let wrong = unique.clone().filter(|judged| !judged.is_found()).count();
    let (most_m, most_deg) = SUCCESS;
    let share = 100.0 * found as f64 / judged.len().max(1) as f64;
    Heading::plain(
        format!("{bag} · errors against /ground_truth"),
        format!(
            "{} scans with a true pose: {share:.1} % within {most_m} m and {most_deg}°; {} called Unique, {wrong} of them wrong",
            judged.len(),
            unique.count(),
        ),
    )
}

fn name(legend: &mut Legend, judged: &[Judged], unit: f64) {
    for verdict in theme::VERDICTS {
        let scans = judged.iter().filter(|scan| scan.verdict == verdict);
        let count = scans.count();
        if count > 0 {
            let (color, shape) = theme::of_verdict(verdict);
            let name = format!("{} ({count})", verdict.as_str());
            legend.add(Sample::Mark(shape, color), name);
        }
    }
    let (most_m, most_deg) = SUCCESS;
    let name = format!("counts as found: {most_m} m, {most_deg}°");
    legend.add(Sample::Line(limit_stroke(unit)), name);
}

#[cfg(test)]
mod tests {
    use super::super::layout;
    use super::*;

    fn judged(second: i64, verdict: Verdict, off: Option<(f64, f64)>) -> Judged {
        Judged {
            stamp_ns: second * 1_000_000_000,
            verdict,
            off,
        }
    }

    #[test]
    fn the_heading_counts_what_was_found_and_what_was_wrongly_sure() {
        let all = [
            judged(5, Verdict::Unique, Some((0.1, 1.0))),
            judged(6, Verdict::Unique, Some((7.0, 1.0))),
            judged(7, Verdict::Ambiguous, Some((0.1, 20.0))),
            judged(9, Verdict::NoScan, None),
        ];
        let says = heading(&all, "r.mcap").says;
        assert_eq!(
            says,
            "4 scans with a true pose: 25.0 % within 0.5 m and 10°; 2 called Unique, 1 of them wrong"
        );
        assert_eq!(duration_s(&all), 4.0);
        assert_eq!(seconds(&all, &all[1]), 1.0);
    }

    #[test]
    fn what_has_no_error_or_one_below_the_axis_is_marked_and_named() {
        let far = judged(5, Verdict::Unique, Some((0.1, 1.0)));
        let below = "below the axis: less than 0.001 m or 0.01°";
        let nowhere = "no place, so no error";
        let has = |all: &[Judged], name: &str| {
            let texts = layout::texts(&draw(all, "r.mcap", 1200).unwrap());
            texts.contains(&name.to_owned())
        };
        assert!(has(&[far], "Unique (1)") && has(&[far], "counts as found: 0.5 m, 10°"));
        assert!(!has(&[far], below) && !has(&[far], nowhere));
        assert!(has(
            &[far, judged(6, Verdict::Unique, Some((0.0, 1.0)))],
            below
        ));
        assert!(has(&[far, judged(7, Verdict::NoScan, None)], nowhere));
    }

    #[test]
    fn stamps_from_a_damaged_clock_do_not_overflow() {
        let all = [i64::MIN, i64::MAX].map(|stamp_ns| Judged {
            stamp_ns,
            ..judged(0, Verdict::Unique, Some((0.0, 0.0)))
        });
        assert!(duration_s(&all).is_finite());
        assert!(draw(&all, "r.mcap", 300).is_ok());
    }
}
