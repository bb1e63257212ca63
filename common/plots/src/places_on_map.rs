//! A map with numbered places: where each was found, where it truly was, and the way.

use drawing::{Anchor, Color, Path, Scene, Stroke, TextStyle};
use engine::grid::CellRules;
use geometry::Pose;
use map::OccupancyGrid;

use super::axes;
use super::extent::Extent;
use super::page::{self, Entry, Heading, Page, Sample};
use super::view::View;
use super::{ground, marks, theme};
use crate::PlotError;

/// The body's height as a share of its width.
const HEIGHTS: (f64, f64) = (0.25, 0.9);

/// Draws the map, the true path over it, and places by their numbers from 1: found, and
/// true.
///
/// # Errors
/// The picture would be too large.
pub fn draw(
    (map, rules): (&OccupancyGrid, CellRules),
    path: &[Pose],
    places: &[(Pose, Pose)],
    (title, says): (String, String),
) -> Result<Scene, PlotError> {
    let width = page::COMMON_WIDTH;
    let around = path.iter().map(|pose| (pose.x, pose.y));
    let all = Extent::of_map(map);
    let extent = Extent::of(around).with_rim(0.15, 8.0).within(all);
    let ratio = (extent.height() / extent.width()).clamp(HEIGHTS.0, HEIGHTS.1);
    let height = (page::body_width(width) * ratio).round();
    let heading = Heading {
        title,
        verdict: None,
        says,
    };
    let unit = page::unit(width);
    let mut page = Page::new(width, height, &heading, &legend(unit))?;
    let view = View::fitting(extent, axes::inside(page.body, unit));
    let ink = ground::occupied(map, rules);
    ground::draw(&mut page.scene, map, rules, &view, ink)?;
    let at = |pose: &Pose| view.at((pose.x, pose.y));
    page.scene.clipped(view.area(), |scene| {
        scene.stroke(Path::polyline(path.iter().map(at)), way(unit));
        for (number, (found, truth)) in (1..).zip(places) {
            marks::truth(scene, marks::placement(&view, *truth), 10.0 * unit);
            marks::robot(
                scene,
                marks::placement(&view, *found),
                9.0 * unit,
                theme::BEST,
            );
            let style = TextStyle::new(20.0 * unit, theme::INK)
                .bold()
                .anchored(Anchor::Middle)
                .with_halo(Color::WHITE, 5.0 * unit);
            let (x, y) = at(found);
            scene.text(&format!("{number}"), (x, y - 18.0 * unit), &style);
        }
    });
    axes::draw_metres(&mut page.scene, &view, unit);
    Ok(page.scene)
}

fn way(unit: f64) -> Stroke {
    Stroke::new(theme::CURVES[5], 2.0 * unit)
}

fn legend(unit: f64) -> Vec<Entry> {
    vec![
        (Sample::Line(way(unit)), "path".to_owned()),
        (Sample::Robot(theme::BEST), "found".to_owned()),
        (Sample::Truth, "truth".to_owned()),
        (Sample::Square(theme::UNKNOWN), "unknown".to_owned()),
    ]
}
