//! A drive from above: the map, and where the tracker had the robot and was not sure.

use crate::drawing::{Color, Path, Scene, Stroke};
use engine::grid::CellRules;
use geometry::Pose;
use map::OccupancyGrid;
use messages::TrackState;

use super::extent::Extent;
use super::ground::Ground;
use super::legend::{Legend, Sample};
use super::page::{self, Heading, Page};
use super::view::View;
use super::{axes, theme};

#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stop {
    pub state: TrackState,
    /// Where the tracker has the laser.
    pub pose: Option<Pose>,
    pub truth: Option<Pose>,
}

/// They are as high as the drive asks for, within these shares of their width.
const HEIGHTS: (f64, f64) = (0.3, 1.2);

/// The size of marks, pixels of a picture of the common width.
const MARK: f64 = 3.0;

/// Around the drive, metres are shown.
const MARGIN_M: f64 = 3.0;

/// Draws a drive; what it says stands above it.
pub fn draw(
    map: &OccupancyGrid,
    rules: CellRules,
    stops: &[Stop],
    (title, says): (String, String),
) -> anyhow::Result<Scene> {
    let places = stops.iter().flat_map(|it| [it.pose, it.truth]).flatten();
    let corners = places.flat_map(|pose| {
        let around = [-MARGIN_M, MARGIN_M];
        around.map(|by| (pose.x + by, pose.y + by))
    });
    let extent = Extent::of(corners).within(Extent::of_map(map));
    let heading = Heading::plain(title, says);
    let (mut page, view) = Page::of_map(page::COMMON_WIDTH, extent, HEIGHTS, &heading)?;
    let unit = page.unit;
    let ground = Ground { map, rules };
    ground.draw(&mut page, &view)?;
    let Page { scene, legend, .. } = &mut page;
    scene.clipped(view.area, |scene| {
        draw_path((scene, legend), &view, stops, unit);
        for state in STATES {
            draw_state((scene, legend), &view, (stops, state), unit);
        }
    });
    axes::draw_metres(&mut page.scene, &view, unit);
    page.finish()
}

/// What is rare is drawn last.
const STATES: [TrackState; 4] = [
    TrackState::Unique,
    TrackState::Doubtful,
    TrackState::Searching,
    TrackState::Lost,
];

fn draw_path((scene, legend): (&mut Scene, &mut Legend), view: &View, stops: &[Stop], unit: f64) {
    let truths = stops.iter().filter_map(|stop| stop.truth);
    let path: Vec<_> = truths.map(|pose| view.at((pose.x, pose.y))).collect();
    if path.len() > 1 {
        let stroke = Stroke::new(theme::TRUTH.with_opacity(0.45), 1.6 * unit);
        scene.stroke(Path::polyline(path), stroke);
        legend.add(Sample::Line(stroke), "true path");
    }
}

/// Draws the marks of a state, at the true place while nothing was known.
fn draw_state(
    (scene, legend): (&mut Scene, &mut Legend),
    view: &View,
    (stops, state): (&[Stop], TrackState),
    unit: f64,
) {
    let (color, shape, name) = theme::of_state(state);
    let stops = stops.iter().filter(|stop| stop.state == state);
    let place = |stop: &Stop| match state {
        TrackState::Searching => stop.truth,
        _ => stop.pose,
    };
    let (size, mut marks) = (MARK * unit, Path::default());
    let mut count = 0;
    for pose in stops.filter_map(place) {
        marks.add(&shape.at(view.at((pose.x, pose.y)), size));
        count += 1;
    }
    if count > 0 {
        if state != TrackState::Unique {
            scene.stroke(marks.clone(), Stroke::new(Color::WHITE, 1.6 * unit));
        }
        scene.fill(marks, color);
        legend.add(Sample::Mark(shape, color), format!("{name} ({count})"));
    }
}

#[cfg(test)]
mod tests {
    use super::super::layout;
    use super::*;

    #[test]
    fn states_are_named_as_far_as_they_are_drawn() {
        let map = OccupancyGrid::from_parts(90, 40, 0.1, Pose::IDENTITY, vec![0; 90 * 40]);
        let stop = |state, x| Stop {
            state,
            pose: (state != TrackState::Searching).then_some(Pose::new(x, 2.0, 0.0)),
            truth: Some(Pose::new(x, 2.1, 0.0)),
        };
        let stops = [
            stop(TrackState::Searching, 1.0),
            stop(TrackState::Unique, 2.0),
            stop(TrackState::Unique, 3.0),
        ];
        let words = ("a drive".to_owned(), "scans".to_owned());
        let scene = draw(&map.unwrap(), CellRules::default(), &stops, words).unwrap();
        let all = layout::texts(&scene);
        for name in [
            "true path",
            "unique (2)",
            "searching, at the true place (1)",
            "x, m",
        ] {
            assert!(all.contains(&name.to_owned()), "{name}: {all:?}");
        }
        assert!(!all.iter().any(|name| name.starts_with("lost")));
    }
}
