//! The picture of one scan: the map with the scan at its places, and where they
//! are worth comparing, each of them from near.

use crate::drawing::{Rect, Scene};
use geometry::Pose;
use offline::ScanAt;

use super::extent::Extent;
use super::ground::Ground;
use super::page::{self, Page};
use super::subject::Subject;
use super::{axes, marks, places, theme};

/// Most places that are shown from near.
const MAX_NEAR: usize = 3;
/// Limits of the body's height as a share of its width.
const HEIGHTS: (f64, f64) = (0.25, 1.0);
/// From here on the places from near stand beside the map.
const HIGH: f64 = 0.65;
const HIGHEST_ABOVE_NEAR: f64 = 0.5;
const HIGHEST_BESIDE_NEAR: f64 = 1.35;
/// The map's share of the width there.
const BESIDE_NEAR: f64 = 0.6;
/// The height of a place from near, as a share of its width.
const NEAR_HEIGHT: f64 = 0.8;
/// The line above a place from near, and the least height of both.
const CAPTION: f64 = 26.0;
const LEAST_NEAR: f64 = 250.0;
/// From near, this many of the beams are seen from end to end.
const NEAR_SHARE: f64 = 0.85;
const GAP: f64 = 10.0;

#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Size {
    pub(super) width: u32,
    /// Shows the whole map and not only what matters.
    pub(super) whole: bool,
}

struct Near<'a> {
    name: String,
    /// `None` at the truth.
    rank: Option<usize>,
    pose: Pose,
    scan: &'a ScanAt,
}

pub(super) fn draw(
    ground: &Ground<'_>,
    subject: &Subject,
    bag: &str,
    size: Size,
) -> anyhow::Result<Scene> {
    let extent = subject.extent(ground, size.whole);
    let near = worth_comparing(subject);
    let (unit, width) = (page::unit(size.width), page::body_width(size.width));
    let ratio = extent.height() / extent.width();
    let layout = Layout::new(ratio, near.len(), width, unit);
    let mut page = Page::new(size.width, layout.height, &subject.heading(bag))?;
    let corner = (page.body.x, page.body.y);
    let view = axes::view_within(extent, moved(layout.map, corner), unit);
    ground.draw(&mut page, &view)?;
    places::draw((&mut page.scene, &mut page.legend), &view, subject, unit);
    axes::draw_metres(&mut page.scene, &view, unit);
    let reach = reach_m(subject);
    for (near, area) in near.iter().zip(&layout.near) {
        draw_near(&mut page, ground, (near, reach), moved(*area, corner))?;
    }
    if near.is_empty() {
        places::count(&mut page.legend, subject);
    }
    page.finish()
}

#[derive(Debug, Clone, PartialEq)]
struct Layout {
    height: f64,
    map: Rect,
    near: Vec<Rect>,
}

impl Layout {
    /// Places from near stand below a part of the map, or to the right where `ratio` is high.
    fn new(ratio: f64, near: usize, width: f64, unit: f64) -> Self {
        if near == 0 {
            return Layout::below(ratio.clamp(HEIGHTS.0, HEIGHTS.1), 0, width, unit);
        }
        if ratio < HIGH {
            let ratio = ratio.clamp(HEIGHTS.0, HIGHEST_ABOVE_NEAR);
            return Layout::below(ratio, near, width, unit);
        }
        Layout::beside(ratio.min(HIGHEST_BESIDE_NEAR), near, width, unit)
    }

    fn below(ratio: f64, near: usize, width: f64, unit: f64) -> Self {
        let gap = GAP * unit;
        let map = Rect::new(0.0, 0.0, width, axes::height_for(ratio, width, unit));
        let columns = near.max(1) as f64;
        let column = (width - gap * (columns - 1.0)) / columns;
        let row = (column * NEAR_HEIGHT).min(0.4 * width) + CAPTION * unit;
        let at = |i: usize| Rect::new(i as f64 * (column + gap), map.height + gap, column, row);
        Layout {
            height: map.height + if near > 0 { gap + row } else { 0.0 },
            map,
            near: (0..near).map(at).collect(),
        }
    }

    fn beside(ratio: f64, near: usize, width: f64, unit: f64) -> Self {
        let gap = GAP * unit;
        let map_width = (width - gap) * BESIDE_NEAR;
        let map_height = axes::height_for(ratio, map_width, unit);
        let least = near as f64 * LEAST_NEAR * unit;
        let map = Rect::new(0.0, 0.0, map_width, map_height.max(least));
        let rows = near as f64;
        let row = (map.height - gap * (rows - 1.0)) / rows;
        let left = map_width + gap;
        let at = |i: usize| Rect::new(left, i as f64 * (row + gap), width - left, row);
        Layout {
            height: map.height,
            map,
            near: (0..near).map(at).collect(),
        }
    }
}

fn moved(area: Rect, (x, y): (f64, f64)) -> Rect {
    Rect::new(area.x + x, area.y + y, area.width, area.height)
}

/// Places worth comparing: the best, its rivals and a missed truth; none if there is one alone.
fn worth_comparing(subject: &Subject) -> Vec<Near<'_>> {
    let truth = subject.missed_truth();
    let rivals = 1 + subject.places.alternatives as usize;
    let places = match truth {
        Some(_) => (MAX_NEAR - 1).min(rivals),
        None => MAX_NEAR.min(rivals),
    };
    let shown = subject.shown.iter().take(places);
    let mut near: Vec<Near<'_>> = shown
        .map(|shown| Near {
            name: format!("{}: score {:.2}", shown.rank, shown.scan.score),
            rank: Some(shown.rank),
            pose: shown.place.map_from_laser,
            scan: &shown.scan,
        })
        .collect();
    near.extend(truth.map(|truth| Near {
        name: format!("truth: score {:.2}", truth.scan.score),
        rank: None,
        pose: truth.pose,
        scan: &truth.scan,
    }));
    if near.len() < 2 {
        near.clear();
    }
    near
}

/// How far most beams of the best place reach, metres.
fn reach_m(subject: &Subject) -> f64 {
    let reach = subject.shown.first().map(|best| {
        let pose = best.place.map_from_laser;
        best.scan.reach_m(pose, NEAR_SHARE)
    });
    reach.unwrap_or_default().max(3.0)
}

fn draw_near(
    page: &mut Page,
    ground: &Ground<'_>,
    (near, reach): (&Near<'_>, f64),
    area: Rect,
) -> anyhow::Result<()> {
    let unit = page.unit;
    let style = theme::fitted(theme::text(unit).bold(), &near.name, area.width);
    let at = (area.x, area.y + 0.75 * CAPTION * unit);
    page.scene.text(&near.name, at, &style);
    let top = area.y + CAPTION * unit;
    let rest = Rect::new(area.x, top, area.width, area.bottom() - top);
    let view = axes::view_within(Extent::around(near.pose, reach), rest, unit);
    ground.draw(page, &view)?;
    let Page { scene, legend, .. } = page;
    scene.clipped(view.area, |scene| {
        places::by_class((scene, legend), &view, (near.pose, near.scan), unit);
        let placement = marks::placement(&view, near.pose);
        let size = places::ROBOT * unit;
        match near.rank {
            None => marks::truth(scene, placement, places::TRUTH * unit),
            Some(1) => marks::robot(scene, placement, size, theme::BEST),
            Some(_) => marks::robot(scene, placement, size, theme::OTHER),
        }
    });
    axes::draw_metres(scene, &view, unit);
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_from_near_stand_below_a_wide_map_and_beside_a_high_one() {
        let wide = Layout::new(0.4, 3, 1000.0, 1.0);
        assert_eq!(wide.map.width, 1000.0);
        let top = wide.map.bottom() + GAP;
        assert!(wide.near.iter().all(|area| area.y == top));
        let high = Layout::new(1.0, 2, 1000.0, 1.0);
        assert_eq!(high.map.width, 594.0);
        assert!(high.near.iter().all(|area| area.x == 604.0));
        for layout in [wide, high, Layout::new(9.0, 3, 1000.0, 0.4)] {
            let lowest = layout.near.iter().map(Rect::bottom).fold(0.0, f64::max);
            let right = layout.near.iter().map(Rect::right).fold(0.0, f64::max);
            // Sums of a few parts of the width.
            assert!((lowest - layout.height).abs() < 1e-9, "{layout:?}");
            assert!(right > 999.999 && right < 1000.001, "{layout:?}");
        }
    }
}
