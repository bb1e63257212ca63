//! Curves over a common axis, with the interval of each point: tables as a picture.

use crate::drawing::{Path, Rect, Scene, Stroke};

use super::axes::{self, Axis};
use super::legend::Sample;
use super::page::{self, Heading, Page};
use super::scale::Scale;
use super::shapes::Shape;
use super::theme;

/// The body's height as a share of its width.
const HEIGHT: f64 = 0.5;

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
    pub name: String,
    /// Which of the colours, and marks, of curves it has.
    pub color: usize,
    /// Figures that were not measured, but calculated or printed, are dashed.
    pub is_dashed: bool,
    pub points: Vec<CurvePoint>,
}

#[derive(Debug, Clone, PartialEq)]
pub struct Curves {
    pub title: String,
    pub says: String,
    /// What the axes measure, with their units.
    pub x: String,
    /// What the axis upward shows.
    pub y: String,
    /// Whether the axis upwards is one of decades; else it begins at 0.
    pub by_decades: bool,
    pub curves: Vec<Curve>,
}

pub fn draw(chart: &Curves) -> anyhow::Result<Scene> {
    let width = page::COMMON_WIDTH;
    let heading = Heading::plain(&chart.title, &chart.says);
    let unit = page::unit(width);
    let height = axes::height_for(HEIGHT, page::body_width(width), unit);
    let mut page = Page::new(width, height, &heading)?;
    let scales = scales(chart);
    let x = Axis {
        scale: scales.0,
        name: &chart.x,
    };
    let y = Axis {
        scale: scales.1,
        name: &chart.y,
    };
    let area = axes::inside(page.body, (&x, &y), unit);
    axes::draw_grating(&mut page.scene, area, (x, y), unit);
    for curve in &chart.curves {
        draw_curve(&mut page, curve, (area, scales), unit);
    }
    name_others(&mut page, chart, scales.1);
    axes::draw(&mut page.scene, area, (x, y), unit);
    page.finish()
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

fn draw_curve(page: &mut Page, curve: &Curve, (area, (x, y)): (Rect, (Scale, Scale)), unit: f64) {
    let at = |px: f64, py: f64| {
        (
            area.x + area.width * x.share(px),
            area.bottom() - area.height * y.share(py),
        )
    };
    let line = stroke(curve, unit);
    let points = || curve.points.iter().map(|point| at(point.x, point.y));
    page.scene.stroke(Path::polyline(points()), line);
    let solid = Stroke::new(line.color, 1.4 * unit);
    let (mut bars, mut beyond) = (Path::default(), Path::default());
    for point in &curve.points {
        let (low, high) = point.interval.unwrap_or((point.y, point.y));
        bars.add_line(at(point.x, low), at(point.x, high));
        for end in [low, high]
            .into_iter()
            .filter(|&end| !y.is_below(end) && low < high)
        {
            let (end_x, end_y) = at(point.x, end);
            bars.add_line((end_x - 4.0 * unit, end_y), (end_x + 4.0 * unit, end_y));
        }
        if is_below(point, y) {
            beyond.add(&Shape::Down.at(at(point.x, low), 4.5 * unit));
        }
    }
    page.scene.stroke(bars, solid);
    page.scene.stroke(beyond, solid);
    let shape = Shape::ALL[curve.color % Shape::ALL.len()];
    if curve.is_dashed {
        page.legend.add(Sample::Line(line), &*curve.name);
        return;
    }
    page.legend.add(Sample::Curve(line, shape), &*curve.name);
    let shown = curve.points.iter().filter(|point| !y.is_below(point.y));
    for point in shown {
        let mark = shape.at(at(point.x, point.y), 4.5 * unit);
        page.scene.fill(mark, line.color);
    }
}

/// Whether a point, or its interval, goes on below the axis: a scale of decades has no 0.
fn is_below(point: &CurvePoint, y: Scale) -> bool {
    let low = point.interval.map_or(point.y, |(low, _)| low);
    y.is_below(low.min(point.y))
}

/// Names the intervals, and what does not lie on the axis.
fn name_others(page: &mut Page, chart: &Curves, y: Scale) {
    let ink = Stroke::new(theme::INK, 1.4 * page.unit);
    let mut points = chart.curves.iter().flat_map(|curve| &curve.points);
    if points.clone().any(|point| point.interval.is_some()) {
        page.legend.add(Sample::Bar(ink), "interval of 95 %");
    }
    if points.any(|point| is_below(point, y)) {
        let sample = Sample::Outline(Shape::Down, theme::INK);
        page.legend.add(sample, "goes on below the axis");
    }
}

#[cfg(test)]
mod tests {
    use super::super::layout;
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
        assert_eq!(x, Scale::Even(0.0, 140.0));
        let Scale::Decades(low, high) = y else {
            panic!("{y:?}");
        };
        assert!(low <= 2.0 && high >= 30.0, "{low} {high}");
    }

    #[test]
    fn what_lies_below_the_axis_is_said() {
        let texts = |chart: &Curves| layout::texts(&draw(chart).unwrap());
        let has = |texts: &[String], name: &str| texts.iter().any(|text| text == name);
        let whole = texts(&chart());
        for name in ["a", "interval of 95 %", "p/n, %", "ratio"] {
            assert!(has(&whole, name), "{name}: {whole:?}");
        }
        assert!(!has(&whole, "goes on below the axis"), "{whole:?}");
        let mut below = chart();
        below.curves[0].points[0].interval = Some((0.0, 4.0));
        assert!(has(&texts(&below), "goes on below the axis"));
        below.by_decades = false;
        assert!(
            !has(&texts(&below), "goes on below the axis"),
            "0 is on this axis"
        );
    }
}
