//! A map with numbered places: where each was found, where it truly was, and the way.

use crate::drawing::{Color, Path, Scene, Stroke};
use engine::grid::CellRules;
use geometry::Pose;
use map::OccupancyGrid;

use super::extent::Extent;
use super::ground::Ground;
use super::legend::Sample;
use super::numbers::Numbers;
use super::page::{self, Heading, Page};
use super::{axes, marks, theme};

/// The body's height as a share of its width.
const HEIGHTS: (f64, f64) = (0.25, 0.9);

/// Draws the map, the true path, and places by their numbers from 1: found, and true.
pub fn draw(
    (map, rules): (&OccupancyGrid, CellRules),
    path: &[Pose],
    places: &[(Pose, Pose)],
    (title, says): (String, String),
) -> anyhow::Result<Scene> {
    let around = path.iter().map(|pose| (pose.x, pose.y));
    let all = Extent::of_map(map);
    let extent = Extent::of(around).with_rim(0.15, 8.0).within(all);
    let heading = Heading::plain(title, says);
    let (mut page, view) = Page::of_map(page::COMMON_WIDTH, extent, HEIGHTS, &heading)?;
    let unit = page.unit;
    Ground { map, rules }.draw(&mut page, &view)?;
    let way = Stroke::new(theme::CURVES[5], 2.0 * unit);
    page.legend.add(Sample::Line(way), "path");
    page.legend.add(Sample::Robot(theme::BEST), "found");
    page.legend.add(Sample::Truth, "truth");
    let at = |pose: &Pose| view.at((pose.x, pose.y));
    page.scene.clipped(view.area, |scene| {
        scene.stroke(Path::polyline(path.iter().map(at)), way);
        let mut numbers = Numbers::new(view.area);
        let poses = places.iter().flat_map(|(found, truth)| [found, truth]);
        poses.for_each(|pose| numbers.keep_free(at(pose), 18.0 * unit));
        for (number, (found, truth)) in (1..).zip(places) {
            marks::truth(scene, marks::placement(&view, *truth), 10.0 * unit);
            let placement = marks::placement(&view, *found);
            marks::robot(scene, placement, 9.0 * unit, theme::BEST);
            let style = theme::title(unit).with_halo(Color::WHITE, 5.0 * unit);
            numbers.write(scene, &format!("{number}"), at(found), &style);
        }
    });
    axes::draw_metres(&mut page.scene, &view, unit);
    page.finish()
}
