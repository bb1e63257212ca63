//! Picture of the votes of each position at the best heading, as figure 4b of the paper.

use crate::drawing::{Color, Path, Scene, Stroke};
use engine::grid::CellRules;
use geometry::Pose;
use map::{OccupancyGrid, UNKNOWN};
use offline::{Field, frame_of, sides_of};

use super::axes::{self, Axis};
use super::extent::Extent;
use super::ground::{Ground, Sampler};
use super::legend::Sample;
use super::marks;
use super::page::{self, Heading, Page};
use super::scale::Scale;
use super::scan::Size;
use super::subject::Subject;
use super::theme;
use super::view::View;

const HEIGHTS: (f64, f64) = (0.25, 1.0);
/// About what the bar of colours takes from the width.
const BAR_ROOM: f64 = 110.0;

#[derive(Debug)]
pub struct Votes<'a> {
    pub(super) ground: Ground<'a>,
    pub(super) field: &'a Field,
    pub(super) heading: Heading,
    pub(super) extent: Extent,
    pub(super) truth: Option<Pose>,
    pub(super) width: u32,
}

impl<'a> Votes<'a> {
    /// Those of a scan at the heading of its best place.
    pub(super) fn of(
        ground: Ground<'a>,
        (subject, field): (&Subject, &'a Field),
        bag: &str,
        size: Size,
    ) -> Self {
        Votes {
            ground,
            field,
            heading: heading(subject, field, bag),
            extent: subject.extent(&ground, size.whole),
            truth: subject.truth.as_ref().map(|truth| truth.pose),
            width: size.width,
        }
    }

    /// Those on a whole map.
    pub fn whole(
        (map, rules): (&'a OccupancyGrid, CellRules),
        field: &'a Field,
        truth: Option<Pose>,
        (title, says): (String, String),
    ) -> Self {
        Votes {
            ground: Ground { map, rules },
            field,
            heading: Heading::plain(title, says),
            extent: Ground { map, rules }.known(),
            truth,
            width: page::COMMON_WIDTH,
        }
    }

    /// Returns a function from the column and row of a view's pixel to the highest share of the most
    /// votes under it, and the share of walls.
    pub(super) fn sampler(&self, view: &View) -> impl Fn(u32, u32) -> (f64, f64) {
        let (field, Ground { map, rules }) = (self.field, self.ground);
        let cells = Sampler::new(view, frame_of(map), sides_of(map));
        let under = Sampler::new(view, field.frame, field.sides);
        let most = f64::from(field.outcome.found.best.max(1));
        let is_wall = move |index: usize| {
            let value = map.cells.get(index).copied().unwrap_or(UNKNOWN);
            rules.is_occupied(value)
        };
        move |column, row| {
            let mut highest = 0;
            under.each(column, row, |index| {
                let intensity = index.and_then(|index| field.intensities.get(index));
                highest = highest.max(intensity.copied().unwrap_or_default());
            });
            let (mut met, mut walls) = (0.0_f64, 0.0);
            cells.each(column, row, |index| {
                met += 1.0;
                walls += f64::from(u8::from(index.is_some_and(is_wall)));
            });
            (f64::from(highest) / most, (walls / met.max(1.0)).sqrt())
        }
    }

    pub(super) fn scale(&self) -> Axis<'static> {
        let most = f64::from(self.field.outcome.found.best.max(1));
        Axis {
            scale: Scale::Even(0.0, most),
            name: "votes",
        }
    }
}

fn heading(subject: &Subject, field: &Field, bag: &str) -> Heading {
    let best = field.outcome.found.best;
    let degrees = field.outcome.known_heading.unwrap_or_default().to_degrees();
    Heading {
        title: format!(
            "{bag} · scan {}: votes at heading {degrees:.1}°",
            subject.number
        ),
        verdict: Some(subject.places.verdict),
        says: format!(
            "the best position has {best} of {} votes possible, from {} beams; {}",
            field.outcome.highest_possible,
            field.outcome.beams_used,
            subject.places.sentence()
        ),
    }
}

pub fn draw(votes: &Votes<'_>) -> anyhow::Result<Scene> {
    let extent = votes.extent;
    let ratio = (extent.height() / extent.width()).clamp(HEIGHTS.0, HEIGHTS.1);
    let (width, unit) = (page::body_width(votes.width), page::unit(votes.width));
    let height = axes::height_for(ratio, width - BAR_ROOM * unit, unit);
    let mut page = Page::new(votes.width, height, &votes.heading)?;
    let (rest, bar) = axes::beside_bar(page.body, &votes.scale(), unit);
    let view = axes::view_within(extent, rest, unit);
    if fill(&mut page.scene, votes, &view)? {
        page.legend.add(Sample::Area(WALL), "obstacle");
    }
    let Page { scene, legend, .. } = &mut page;
    scene.clipped(view.area, |scene| {
        if let Some(best) = best_position(votes.field) {
            let ring = Path::circle(view.at(best), 16.0 * unit);
            scene.stroke(ring.clone(), Stroke::new(Color::WHITE, 6.0 * unit));
            scene.stroke(ring, Stroke::new(theme::BEST, 2.4 * unit));
            legend.add(Sample::Ring(theme::BEST), "most votes");
        }
        if let Some(truth) = votes.truth {
            marks::truth(scene, marks::placement(&view, truth), 7.0 * unit);
            legend.add(Sample::Truth, "truth");
        }
    });
    axes::draw_metres(&mut page.scene, &view, unit);
    axes::draw_bar(&mut page.scene, bar, votes.scale(), theme::heat, unit);
    page.finish()
}

/// Where most votes meet, in the map, metres.
pub(super) fn best_position(field: &Field) -> Option<(f64, f64)> {
    let best = field.outcome.found.votes.first()?;
    let (x, y) = (f64::from(best.x) + 0.5, f64::from(best.y) + 0.5);
    let pose = field.frame.map_from_cells(x, y, 0.0);
    Some((pose.x, pose.y))
}

/// Fills a view with the votes and the walls; whether there is a wall.
fn fill(scene: &mut Scene, votes: &Votes<'_>, view: &View) -> anyhow::Result<bool> {
    let (sampled, mut any_wall) = (votes.sampler(view), false);
    scene.image(view.area, |column, row| {
        let (share, walls) = sampled(column, row);
        any_wall |= walls > 0.0;
        theme::heat(share).towards(WALL, walls)
    })?;
    Ok(any_wall)
}

/// Walls stand back behind the votes.
pub(super) const WALL: Color = Color::rgb(0x7C_8896);
