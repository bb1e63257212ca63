//! The picture of a drive: how far off the best place of each scan is, and what
//! the verdict says.

use drawing::{Anchor, Color, Path, Rect, Scene, TextStyle};
use messages::Verdict;
use statistics::SUCCESS;

use super::chart::Chart;
use super::page::{self, Entry, Heading, Page, Sample};
use super::theme;
use crate::PlotError;

/// A scan whose truth is known.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Judged {
    /// When it was measured, nanoseconds since 1970.
    pub(super) stamp_ns: i64,
    pub(super) verdict: Verdict,
    /// From the best place to the true one, metres and degrees; `None` where
    /// the scan was refused or has no place.
    pub(super) off: Option<(f64, f64)>,
}

impl Judged {
    fn is_found(&self) -> bool {
        let (most_m, most_deg) = SUCCESS;
        self.off
            .is_some_and(|(metres, degrees)| metres <= most_m && degrees <= most_deg)
    }
}

const VERDICTS: [Verdict; 4] = [
    Verdict::Unique,
    Verdict::Ambiguous,
    Verdict::PoorFit,
    Verdict::NoScan,
];
/// The height of each chart as a share of the width.
const HEIGHT: f64 = 0.24;
/// The least errors that scales go down to: what a truth is good for.
const LEAST: (f64, f64) = (0.001, 0.01);
const LEFT: f64 = 84.0;
const ABOVE: f64 = 30.0;
const BELOW: f64 = 28.0;

/// Draws the picture of at least one judged scan.
///
/// # Errors
/// The picture would be too large.
pub(super) fn draw(judged: &[Judged], bag: &str, width: u32) -> Result<Scene, PlotError> {
    let unit = page::unit(width);
    let chart_height = (page::body_width(width) * HEIGHT).round();
    let one = chart_height + (ABOVE + BELOW) * unit;
    let heading = heading(judged, bag);
    let mut page = Page::new(width, 2.0 * one, &heading, &legend(judged))?;
    let body = page.body;
    let area = |top: f64| {
        let left = body.x + LEFT * unit;
        Rect::new(
            left,
            top + ABOVE * unit,
            body.right() - left - 12.0 * unit,
            chart_height,
        )
    };
    let (most_m, most_deg) = SUCCESS;
    let metres = Series {
        name: "position",
        unit_of_values: " m",
        limit: most_m,
        least: LEAST.0,
        bound: f64::INFINITY,
        value: |(metres, _)| metres,
    };
    let degrees = Series {
        name: "heading",
        unit_of_values: "°",
        limit: most_deg,
        least: LEAST.1,
        bound: 180.0,
        value: |(_, degrees)| degrees,
    };
    metres.draw(&mut page.scene, judged, area(body.y), unit);
    degrees.draw(&mut page.scene, judged, area(body.y + one), unit);
    Ok(page.scene)
}

/// One of both errors.
struct Series {
    name: &'static str,
    unit_of_values: &'static str,
    /// What counts as found.
    limit: f64,
    least: f64,
    /// No error is above.
    bound: f64,
    value: fn((f64, f64)) -> f64,
}

impl Series {
    fn draw(&self, scene: &mut Scene, judged: &[Judged], area: Rect, unit: f64) {
        let values = judged.iter().filter_map(|judged| judged.off);
        let values = values.map(|off| (self.value)(off).max(self.least));
        // The limit shall not lie on the edge.
        let (least, most) = values.fold((self.limit, 1.5 * self.limit), |(low, high), value| {
            (low.min(value), high.max(value))
        });
        let chart = Chart::new(area, duration_s(judged), (least, most), self.bound);
        chart.draw_axes(scene, unit, self.unit_of_values);
        let word = format!("{}{}", self.limit, self.unit_of_values);
        chart.draw_limit(scene, unit, self.limit, &word);
        for verdict in VERDICTS {
            let mut dots = Path::new();
            for scan in judged.iter().filter(|scan| scan.verdict == verdict) {
                if let Some(off) = scan.off {
                    let value = (self.value)(off).max(self.least);
                    dots.add_circle(chart.at(seconds(judged, scan), value), 3.6 * unit);
                }
            }
            scene.fill(dots, theme::of_verdict(verdict).with_opacity(0.85));
        }
        let style = TextStyle::new(15.0 * unit, theme::INK).bold();
        let at = (area.x, area.y - 9.0 * unit);
        let name = format!("error of the {}", self.name);
        scene.text(&name, at, &style.anchored(Anchor::Start));
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
    Heading {
        title: format!("{bag} · errors against /ground_truth"),
        verdict: None,
        says: format!(
            "{} scans with a true pose: {share:.1} % within {most_m} m and {most_deg}°; {} called Unique, {wrong} of them wrong",
            judged.len(),
            unique.count(),
        ),
    }
}

fn legend(judged: &[Judged]) -> Vec<Entry> {
    let mut entries = Vec::new();
    for verdict in VERDICTS {
        let scans = judged.iter().filter(|scan| scan.verdict == verdict);
        let count = scans.count();
        if count > 0 {
            let color = theme::of_verdict(verdict);
            entries.push((Sample::Dot(color), format!("{} {count}", verdict.as_str())));
        }
    }
    let nowhere = judged.iter().filter(|scan| scan.off.is_none()).count();
    if nowhere > 0 {
        let clear = Color::WHITE.with_opacity(0.0);
        entries.push((
            Sample::Dot(clear),
            format!("{nowhere} of them without a place"),
        ));
    }
    entries
}

#[cfg(test)]
mod tests {
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
        assert_eq!(legend(&all).len(), 4);
    }

    #[test]
    fn stamps_from_a_damaged_clock_do_not_overflow() {
        let all = [
            Judged {
                stamp_ns: i64::MIN,
                ..judged(0, Verdict::Unique, Some((0.0, 0.0)))
            },
            Judged {
                stamp_ns: i64::MAX,
                ..judged(0, Verdict::Unique, Some((0.0, 0.0)))
            },
        ];
        assert!(duration_s(&all).is_finite());
        assert!(draw(&all, "r.mcap", 300).is_ok());
    }
}
