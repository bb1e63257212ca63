//! The picture of a difference: a scan where it is expected, and where it was found.
//! Pure, and asks no engine: it draws its arguments.

use drawing::{Color, Path, Scene};
use engine::grid::CellRules;
use geometry::Pose;
use map::OccupancyGrid;

use super::extent::Extent;
use super::marks;
use super::page::{self, Heading, Page, Sample};
use super::places::{ROBOT, TRUTH};
use super::subject::Ground;
use super::theme;
use super::view::View;
use crate::PlotError;

/// Pixels along x.
const WIDTH: u32 = 1200;
/// The body's height as a share of its width.
const HEIGHTS: (f64, f64) = (0.25, 0.75);
const DOT: f64 = 2.4;

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
    let height = (page::body_width(WIDTH) * ratio).round();
    let heading = Heading {
        title: contrast.title.clone(),
        verdict: None,
        says: contrast.says.clone(),
    };
    let legend = [
        (Sample::Truth, "expected".to_owned()),
        (Sample::Robot(theme::BEST), "found".to_owned()),
    ];
    let mut page = Page::new(WIDTH, height, &heading, &legend)?;
    let view = View::fitting(extent, page.body);
    ground.draw(&mut page.scene, &view)?;
    let unit = page.unit;
    page.scene.clipped(view.area(), |scene| {
        for (pose, color) in [
            (contrast.expected, theme::TRUTH),
            (contrast.found, theme::BEST),
        ] {
            let ends = contrast.ends_at(pose);
            dots(scene, &view, &ends, DOT * unit, color.with_opacity(0.6));
        }
        if let Some(pose) = contrast.found {
            marks::robot(
                scene,
                marks::placement(&view, pose),
                ROBOT * unit,
                theme::BEST,
            );
        }
        if let Some(pose) = contrast.expected {
            marks::truth(scene, marks::placement(&view, pose), TRUTH * unit);
        }
    });
    marks::scale_bar(&mut page.scene, &view, unit);
    page.frame(view.area());
    Ok(page.scene)
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
        let all = ground.extent();
        match poses.iter().any(Option::is_some) {
            true => extent.with_rim(0.04, 6.0).within(all),
            false => all,
        }
    }

    fn ends_at(&self, pose: Option<Pose>) -> Vec<(f64, f64)> {
        let Some(pose) = pose else { return Vec::new() };
        let ends = self.ends.iter();
        ends.map(|&(x, y)| pose.transform(x, y)).collect()
    }
}

fn dots(scene: &mut Scene, view: &View, ends: &[(f64, f64)], radius: f64, color: Color) {
    let mut path = Path::new();
    for &end in ends.iter().filter(|end| view.shows(**end)) {
        path.add_circle(view.at(end), radius);
    }
    scene.fill(path, color);
}

#[cfg(test)]
mod tests {
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
    fn both_poses_are_drawn_as_far_as_they_are_there() {
        let pose = Some(Pose::new(4.0, 3.0, 0.3));
        let away = Some(Pose::new(6.0, 5.0, 2.0));
        let shown = |expected, found| {
            let scene = draw(&map(), &contrast(expected, found)).unwrap();
            let marks = [theme::TRUTH, theme::BEST];
            marks.map(|color| pixels(&scene, color))
        };
        // The legend alone has some of each.
        let legend = shown(None, None);
        let [expected, found] = shown(pose, away);
        assert!(expected > legend[0] && found > legend[1]);
        assert_eq!(shown(pose, None)[1], legend[1]);
        assert_eq!(shown(None, away)[0], legend[0]);
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
