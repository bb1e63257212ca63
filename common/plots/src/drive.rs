//! A drive from above: the map, where the tracker had the robot, and where it was not
//! sure.

use drawing::{Path, Scene, Stroke};
use engine::grid::CellRules;
use geometry::Pose;
use map::OccupancyGrid;
use messages::TrackState;

use super::extent::Extent;
use super::page::{self, Entry, Heading, Page, Sample};
use super::view::View;
use super::{ground, marks, theme};
use crate::PlotError;

/// A scan of a drive.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stop {
    /// What the tracker says there.
    pub state: TrackState,
    /// Where the tracker has the laser.
    pub pose: Option<Pose>,
    /// Where it truly was.
    pub truth: Option<Pose>,
}

/// Pictures are this wide.
const WIDTH: u32 = 1200;

/// They are as high as the drive asks for, within these shares of their width.
const HEIGHTS: (f64, f64) = (0.3, 1.2);

/// Around the drive, metres are shown.
const MARGIN_M: f64 = 3.0;

/// Draws a drive; what it says stands above it.
///
/// # Errors
/// The picture would be too large.
pub fn draw(
    map: &OccupancyGrid,
    rules: CellRules,
    stops: &[Stop],
    (title, says): (String, String),
) -> Result<Scene, PlotError> {
    let places = stops
        .iter()
        .flat_map(|stop| [stop.pose, stop.truth])
        .flatten();
    let corners = places.flat_map(|pose| {
        let around = [-MARGIN_M, MARGIN_M];
        around.map(|by| (pose.x + by, pose.y + by))
    });
    let extent = Extent::of(corners).within(Extent::of_map(map));
    let ratio = (extent.height() / extent.width()).clamp(HEIGHTS.0, HEIGHTS.1);
    let height = (page::body_width(WIDTH) * ratio).round();
    let heading = Heading {
        title,
        verdict: None,
        says,
    };
    let mut page = Page::new(WIDTH, height, &heading, &legend())?;
    let (unit, view) = (page.unit, View::fitting(extent, page.body));
    let ink = ground::occupied(map, rules);
    ground::draw(&mut page.scene, map, rules, &view, ink)?;
    let at = |pose: Pose| view.at((pose.x, pose.y));
    let path: Vec<_> = stops.iter().filter_map(|stop| stop.truth).map(at).collect();
    for pair in path.windows(2) {
        if let [from, to] = *pair {
            let stroke = Stroke::new(theme::TRUTH, 1.2 * unit);
            page.scene.stroke(Path::line(from, to), stroke);
        }
    }
    for stop in stops {
        let Some(pose) = stop.pose else { continue };
        if stop.state != TrackState::Searching {
            let dot = Path::circle(at(pose), 2.4 * unit);
            page.scene.fill(dot, theme::of_state(stop.state));
        }
    }
    // Where nothing was known, the truth says where that was.
    for stop in stops {
        if let (TrackState::Searching, Some(truth)) = (stop.state, stop.truth) {
            let dot = Path::circle(at(truth), 2.4 * unit);
            page.scene.fill(dot, theme::of_state(stop.state));
        }
    }
    marks::scale_bar(&mut page.scene, &view, unit);
    page.frame(view.area());
    Ok(page.scene)
}

fn legend() -> Vec<Entry> {
    let states = [
        (TrackState::Unique, "unique"),
        (TrackState::Doubtful, "doubtful"),
        (TrackState::Lost, "lost"),
        (TrackState::Searching, "searching, at the true place"),
    ];
    let dots = states.map(|(state, name)| (Sample::Dot(theme::of_state(state)), name.to_owned()));
    let truth = Stroke::new(theme::TRUTH, 1.2);
    let mut all = dots.to_vec();
    all.push((Sample::Line(truth), "true path".into()));
    all
}
