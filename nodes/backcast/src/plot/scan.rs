//! The picture of one scan: the map with the scan at its places, and where they
//! are worth comparing, each of them from near.

use drawing::{Color, Rect, Scene, TextStyle};
use geometry::Pose;

use super::extent::Extent;
use super::marks;
use super::page::{self, Page};
use super::places;
use super::subject::{Ground, Subject};
use super::theme;
use super::view::View;
use crate::BackcastError;
use crate::offline::ScanAt;

/// Most places that are shown from near.
const MOST_NEAR: usize = 3;
/// The body of the picture is as high as the part of the map asks for, within
/// these shares of its width.
const HEIGHTS: (f64, f64) = (0.25, 0.75);
/// Where the places are shown from near as well, the map takes less.
const HIGHEST_WITH_NEAR: f64 = 0.5;
/// The height of a place from near, as a share of its width.
const NEAR_HEIGHT: f64 = 0.72;
/// From near, so many of the beams are seen from end to end.
const NEAR_SHARE: f64 = 0.85;
const GAP: f64 = 10.0;

/// How a picture is made.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Size {
    /// Pixels.
    pub(super) width: u32,
    /// Shows the whole map and not only what matters.
    pub(super) whole: bool,
}

/// A place that is shown from near.
struct Near<'a> {
    name: String,
    pose: Pose,
    scan: &'a ScanAt,
}

/// Draws the picture.
///
/// # Errors
/// The picture would be too large.
pub(super) fn draw(
    ground: &Ground<'_>,
    subject: &Subject,
    bag: &str,
    size: Size,
) -> Result<Scene, BackcastError> {
    let extent = match size.whole {
        true => ground.extent(),
        false => subject.extent(ground),
    };
    let near = worth_comparing(subject);
    let (unit, width) = (page::unit(size.width), page::body_width(size.width));
    let highest = if near.is_empty() {
        HEIGHTS.1
    } else {
        HIGHEST_WITH_NEAR
    };
    let ratio = (extent.height() / extent.width()).clamp(HEIGHTS.0, highest);
    let map_height = (width * ratio).round();
    let gap = GAP * unit;
    let columns = near.len() as f64;
    let near_width = (width - gap * (columns - 1.0)) / columns.max(1.0);
    let near_height = match near.is_empty() {
        true => 0.0,
        false => (near_width * NEAR_HEIGHT).min(0.36 * width),
    };
    let below = if near.is_empty() {
        0.0
    } else {
        gap + near_height
    };
    let mut page = Page::new(
        size.width,
        map_height + below,
        &subject.heading(bag),
        &places::legend(subject),
    )?;
    let body = page.body;
    let area = Rect::new(body.x, body.y, body.width, map_height);
    let view = View::fitting(extent, area);
    ground.draw(&mut page.scene, &view)?;
    places::draw(&mut page.scene, &view, subject, unit);
    marks::scale_bar(&mut page.scene, &view, unit);
    page.frame(view.area());
    let reach = reach_m(subject);
    for (column, near) in (0..).zip(&near) {
        let x = body.x + f64::from(column) * (near_width + gap);
        let area = Rect::new(x, area.bottom() + gap, near_width, near_height);
        draw_near(&mut page, ground, (near, reach), area)?;
    }
    Ok(page.scene)
}

/// The best place beside those that come near it, and beside the truth where
/// that is another; nothing where there is nothing to compare.
fn worth_comparing(subject: &Subject) -> Vec<Near<'_>> {
    let truth = subject.missed_truth();
    let rivals = 1 + subject.places.alternatives as usize;
    let places = match truth {
        Some(_) => (MOST_NEAR - 1).min(rivals),
        None => MOST_NEAR.min(rivals),
    };
    let shown = subject.shown.iter().take(places);
    let mut near: Vec<Near<'_>> = shown
        .map(|shown| Near {
            name: format!("{}: score {:.2}", shown.rank, shown.scan.score),
            pose: shown.place.map_from_laser,
            scan: &shown.scan,
        })
        .collect();
    near.extend(truth.map(|truth| Near {
        name: format!("truth: score {:.2}", truth.scan.score),
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
) -> Result<(), BackcastError> {
    let unit = page.unit;
    let view = View::fitting(Extent::around(near.pose, reach), area);
    ground.draw(&mut page.scene, &view)?;
    let area = view.area();
    page.scene.clipped(area, |scene| {
        places::by_class(scene, &view, (near.pose, near.scan), unit);
        let stand = marks::stand(&view, near.pose);
        match near.name.starts_with("truth") {
            true => marks::truth(scene, stand, 6.5 * unit),
            false => marks::robot(scene, stand, 9.0 * unit, theme::BEST),
        }
    });
    marks::scale_bar(&mut page.scene, &view, unit);
    let style = TextStyle::new(16.0 * unit, theme::INK)
        .bold()
        .with_halo(Color::WHITE, 5.0 * unit);
    let at = (area.x + 10.0 * unit, area.y + 23.0 * unit);
    page.scene.text(&near.name, at, &style);
    page.frame(area);
    Ok(())
}
