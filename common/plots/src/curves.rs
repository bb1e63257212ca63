//! Curves over a common axis, with the interval of each point: tables as a picture.

use drawing::{Path, Rect, Scene, Stroke};

use super::axes::{self, Axis};
use super::page::{self, Entry, Heading, Page, Sample};
use super::scale::Scale;
use super::theme;
use crate::PlotError;

/// The body's height as a share of its width.
const HEIGHT: f64 = 0.5;

/// A point of a curve.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CurvePoint {
    /// Along the axis to the right.
    pub x: f64,
    /// Along the axis upward.
    pub y: f64,
    /// The ends of the interval that holds 95 %; `None` where there is none.
    pub interval: Option<(f64, f64)>,
}

/// Points that belong together, from left to right.
#[derive(Debug, Clone, PartialEq)]
pub struct Curve {
    /// As the legend names it.
    pub name: String,
    /// Which of the colours, and marks, of curves it has.
    pub color: usize,
    /// Figures that were not measured, but calculated or printed, are dashed.
    pub is_dashed: bool,
    /// Its points, from left to right.
    pub points: Vec<CurvePoint>,
}

/// A chart.
#[derive(Debug, Clone, PartialEq)]
pub struct Curves {
    /// Above the chart.
    pub title: String,
    /// Below the title.
    pub says: String,
    /// What the axes measure, with their units.
    pub x: String,
    /// What the axis upward shows.
    pub y: String,
    /// Whether the axis upwards is one of decades; else it begins at 0.
    pub by_decades: bool,
    /// The curves, in the order of the legend.
    pub curves: Vec<Curve>,
}

/// Draws a chart.
///
/// # Errors
/// The picture would be too large.
pub fn draw(chart: &Curves) -> Result<Scene, PlotError> {
    let width = page::COMMON_WIDTH;
    let heading = Heading {
        title: chart.title.clone(),
        verdict: None,
        says: chart.says.clone(),
    };
    let unit = page::unit(width);
    let height = (page::body_width(width) * HEIGHT).round();
    let mut page = Page::new(width, height, &heading, &legend(chart, unit))?;
    let area = axes::inside(page.body, unit);
    let scales = scales(chart);
    axes::draw_grating(&mut page.scene, area, scales, unit);
    for curve in &chart.curves {
        draw_curve(&mut page.scene, curve, (area, scales), unit);
    }
    let x = Axis {
        scale: scales.0,
        name: &chart.x,
    };
    let y = Axis {
        scale: scales.1,
        name: &chart.y,
    };
    axes::draw(&mut page.scene, area, (x, y), unit);
    Ok(page.scene)
}

fn scales(chart: &Curves) -> (Scale, Scale) {
    let points = || chart.curves.iter().flat_map(|curve| &curve.points);
    let x = Scale::from_zero(points().map(|point| point.x));
    let heights = points().flat_map(|point| {
        let (low, high) = point.interval.unwrap_or((point.y, point.y));
        [low, point.y, high]
    });
    let y = match chart.by_decades {
        true => Scale::of_decades(heights),
        false => Scale::from_zero(heights),
    };
    (x, y)
}

fn stroke(curve: &Curve, unit: f64) -> Stroke {
    let color = theme::CURVES[curve.color % theme::CURVES.len()];
    Stroke {
        dash: if curve.is_dashed { 6.0 * unit } else { 0.0 },
        ..Stroke::new(color, 2.0 * unit)
    }
}

fn legend(chart: &Curves, unit: f64) -> Vec<Entry> {
    let entry = |curve: &Curve| (Sample::Line(stroke(curve, unit)), curve.name.clone());
    chart.curves.iter().map(entry).collect()
}

fn draw_curve(scene: &mut Scene, curve: &Curve, (area, (x, y)): (Rect, (Scale, Scale)), unit: f64) {
    let at = |px: f64, py: f64| {
        (
            area.x + area.width * x.share(px),
            area.bottom() - area.height * y.share(py),
        )
    };
    let points: Vec<_> = curve
        .points
        .iter()
        .map(|point| at(point.x, point.y))
        .collect();
    scene.stroke(Path::polyline(points.iter().copied()), stroke(curve, unit));
    let solid = Stroke::new(stroke(curve, unit).color, 1.4 * unit);
    let mut bars = Path::new();
    for point in &curve.points {
        let Some((low, high)) = point.interval else {
            continue;
        };
        let (low, high) = (at(point.x, low), at(point.x, high));
        bars.add_line(low, high);
        for (end_x, end_y) in [low, high] {
            bars.add_line((end_x - 4.0 * unit, end_y), (end_x + 4.0 * unit, end_y));
        }
    }
    scene.stroke(bars, solid);
    if !curve.is_dashed {
        for point in points {
            scene.fill(mark(curve.color, point, 4.5 * unit), solid.color);
        }
    }
}

/// Each colour has a shape, too: a chart may be printed in black.
fn mark(color: usize, (x, y): (f64, f64), size: f64) -> Path {
    let corners: &[(f64, f64)] = match color % 4 {
        0 => return Path::circle((x, y), size),
        1 => &[(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)],
        2 => &[(0.0, -1.3), (1.2, 0.9), (-1.2, 0.9)],
        _ => &[(0.0, -1.4), (1.4, 0.0), (0.0, 1.4), (-1.4, 0.0)],
    };
    Path::polygon(corners.iter().map(|(u, v)| (x + size * u, y + size * v)))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn chart() -> Curves {
        let point = |x, y, interval| CurvePoint { x, y, interval };
        Curves {
            title: "title".into(),
            says: "says".into(),
            x: "p/n, %".into(),
            y: "ratio".into(),
            by_decades: true,
            curves: vec![Curve {
                name: "a".into(),
                color: 0,
                is_dashed: false,
                points: vec![point(10.0, 3.0, Some((2.0, 4.0))), point(120.0, 30.0, None)],
            }],
        }
    }

    #[test]
    fn axes_hold_the_points_and_their_intervals() {
        let (x, y) = scales(&chart());
        assert_eq!(x, Scale::Even(0.0, 120.0));
        let Scale::Decades(low, high) = y else {
            panic!("{y:?}");
        };
        assert!(low <= 2.0 && high >= 30.0, "{low} {high}");
        assert!(draw(&chart()).is_ok());
    }
}
