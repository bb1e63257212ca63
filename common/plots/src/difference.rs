//! The picture of a difference: a scan where it is expected, and where it was found.
//! Pure, and asks no engine: it draws its arguments.

use drawing::Scene;
use engine::grid::CellRules;
use geometry::Pose;
use map::OccupancyGrid;

use super::extent::Extent;
use super::legend::Sample;
use super::marks;
use super::page::{self, Heading, Page};
use super::places::{ROBOT, TRUTH};
use super::shapes::Shape;
use super::subject::Ground;
use super::{axes, theme};
use crate::PlotError;

/// Pixels along x.
const WIDTH: u32 = 1200;
/// The body's height as a share of its width.
const HEIGHTS: (f64, f64) = (0.25, 1.0);
const DOT: f64 = 2.4;
/// Of beams that end where they are expected, and where they were found.
const SHAPES: [Shape; 2] = [Shape::Square, Shape::Circle];

/// What is drawn.
#[derive(Debug, Clone, PartialEq)]
pub struct Contrast {
    /// Which scan of which recording.
    pub title: String,
    /// What differs, in words.
    pub says: String,
    /// Where the beams end, in the laser's frame, metres.
    pub ends: Vec<(f64, f64)>,
    /// Of the laser in the map; `None` where no pose was expected.
    pub expected: Option<Pose>,
    /// Of the laser in the map; `None` where no pose was found.
    pub found: Option<Pose>,
}

/// Draws the picture.
///
/// # Errors
/// The picture would be too large.
pub fn draw(map: &OccupancyGrid, contrast: &Contrast) -> Result<Scene, PlotError> {
    let ground = Ground {
        map,
        rules: CellRules::default(),
    };
    let extent = contrast.extent(&ground);
    let ratio = (extent.height() / extent.width()).clamp(HEIGHTS.0, HEIGHTS.1);
    let (width, unit) = (page::body_width(WIDTH), page::unit(WIDTH));
    let heading = Heading {
        title: contrast.title.clone(),
        verdict: None,
        says: contrast.says.clone(),
    };
    let mut page = Page::new(WIDTH, axes::height_for(ratio, width, unit), &heading)?;
    let view = axes::view_within(extent, page.body, unit);
    ground.draw(&mut page, &view)?;
    let Page { scene, legend, .. } = &mut page;
    let both = [
        (
            contrast.expected,
            theme::TRUTH,
            "the scan where it is expected",
        ),
        (contrast.found, theme::BEST, "the scan where it was found"),
    ];
    scene.clipped(view.area(), |scene| {
        for ((pose, color, name), shape) in both.into_iter().zip(SHAPES) {
            let ends = contrast.ends_at(pose);
            let color = color.with_opacity(0.6);
            if marks::ends(scene, &view, ends.into_iter(), (shape, DOT * unit, color)) {
                legend.add(Sample::Mark(shape, color), name);
            }
        }
        if let Some(pose) = contrast.found {
            let placement = marks::placement(&view, pose);
            marks::robot(scene, placement, ROBOT * unit, theme::BEST);
            legend.add(Sample::Robot(theme::BEST), "found");
        }
        if let Some(pose) = contrast.expected {
            marks::truth(scene, marks::placement(&view, pose), TRUTH * unit);
            legend.add(Sample::Truth, "expected");
        }
    });
    axes::draw_metres(&mut page.scene, &view, unit);
    Ok(page.finish()?)
}

impl Contrast {
    /// What the scan reaches from both poses; the whole map where there is none.
    fn extent(&self, ground: &Ground<'_>) -> Extent {
        let poses = [self.expected, self.found];
        let mut extent = Extent::EMPTY;
        for pose in poses {
            extent.include(self.ends_at(pose));
            extent.include(pose.map(|pose| (pose.x, pose.y)));
        }
        match poses.iter().any(Option::is_some) {
            true => extent.with_rim(0.04, 6.0).within(ground.whole()),
            false => ground.known(),
        }
    }

    fn ends_at(&self, pose: Option<Pose>) -> Vec<(f64, f64)> {
        let Some(pose) = pose else { return Vec::new() };
        let ends = self.ends.iter();
        ends.map(|&(x, y)| pose.transform(x, y)).collect()
    }
}

#[cfg(test)]
mod tests {
    use drawing::Color;

    use super::super::layout;
    use super::*;

    fn map() -> OccupancyGrid {
        OccupancyGrid::from_parts(200, 160, 0.05, Pose::IDENTITY, vec![0; 200 * 160]).unwrap()
    }

    fn contrast(expected: Option<Pose>, found: Option<Pose>) -> Contrast {
        Contrast {
            title: "a recording".to_owned(),
            says: "verdict".to_owned(),
            ends: vec![(1.0, 0.0), (0.0, 1.0)],
            expected,
            found,
        }
    }

    /// Pixels of a colour.
    fn pixels(scene: &Scene, color: Color) -> usize {
        let png = drawing::to_png(scene).unwrap();
        let picture = image::load_from_memory(&png).unwrap().to_rgb8();
        let wanted = image::Rgb([color.red, color.green, color.blue]);
        picture.pixels().filter(|pixel| **pixel == wanted).count()
    }

    #[test]
    fn both_poses_are_drawn_and_named_as_far_as_they_are_there() {
        let pose = Some(Pose::new(4.0, 3.0, 0.3));
        let away = Some(Pose::new(6.0, 5.0, 2.0));
        let shown = |expected, found| {
            let scene = draw(&map(), &contrast(expected, found)).unwrap();
            layout::check(&scene);
            let marks = [theme::TRUTH, theme::BEST].map(|color| pixels(&scene, color) > 0);
            let names = ["expected", "found"].map(|name| {
                let labels = scene.labels().iter();
                labels.filter(|label| label.text.contains(name)).count()
            });
            (marks, names)
        };
        // Each is named once as a pose, and once as the scan there.
        assert_eq!(shown(pose, away), ([true, true], [2, 2]));
        assert_eq!(shown(pose, None), ([true, false], [2, 0]));
        assert_eq!(shown(None, away), ([false, true], [0, 2]));
        assert_eq!(shown(None, None), ([false, false], [0, 0]));
    }

    #[test]
    fn the_part_of_the_map_holds_both_poses() {
        let poses = [Pose::new(1.0, 2.0, 0.0), Pose::new(9.0, 6.0, 1.0)];
        let map = map();
        let ground = Ground {
            map: &map,
            rules: CellRules::default(),
        };
        let extent = contrast(Some(poses[0]), Some(poses[1])).extent(&ground);
        assert!(
            extent.width() >= 8.0 && extent.height() >= 4.0,
            "{extent:?}"
        );
    }
}
