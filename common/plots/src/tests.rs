//! What holds for all pictures of a map: labels stand beside each other within the picture,
//! and the legend names whatever is drawn.

use crate::drawing::Scene;
use engine::boundary;
use engine::fit::BeamClass;
use engine::grid::{CellRules, Grid};
use geometry::Pose;
use map::{OccupancyGrid, UNKNOWN};

use super::ground::Ground;
use super::scan::Size;
use super::subject::{Shown, Subject};
use super::{animation, layout, outline, places, scan, theme};

const WIDTHS: [u32; 3] = [300, 600, 1200];

/// A room of ten by seven metres with a thick wall, in a map of which the rest is unknown.
fn map() -> OccupancyGrid {
    let (width, height) = (120_usize, 90_usize);
    let cell = |i: usize| match (i % width, i / width) {
        (0..10 | 110.., _) | (_, 0..10 | 80..) => UNKNOWN,
        (10..13 | 107.., _) | (_, 10..13 | 77..) => 100,
        _ => 0,
    };
    let cells = (0..width * height).map(cell).collect();
    let (width, height) = (width as u32, height as u32);
    OccupancyGrid::from_parts(width, height, 0.1, Pose::IDENTITY, cells).unwrap()
}

fn ground(map: &OccupancyGrid) -> Ground<'_> {
    let rules = CellRules::default();
    Ground { map, rules }
}

/// A scan with a beam of each class at its best place, and eight others far from the truth.
fn ambiguous(x: f64) -> Subject {
    let mut subject = places::tests::subject(Pose::new(x, 4.0, 0.4));
    let best = &mut subject.shown[0];
    let mut end = best.scan.ends[0];
    for (class, shift) in theme::CLASSES.into_iter().zip([0.2, 0.6, 1.0, 1.4]) {
        end.class = class;
        end.at.1 += shift;
        best.scan.ends.push(end);
    }
    let best = best.clone();
    for rank in 2..10 {
        let mut other = Shown {
            rank,
            ..best.clone()
        };
        other.place.map_from_laser = Pose::new(6.0 + 0.1 * rank as f64, 5.0, 1.0);
        other.scan.ends.iter_mut().for_each(|end| end.at.0 += 1.0);
        other.opacity = 0.5;
        subject.shown.push(other);
    }
    subject.places.alternatives = 8;
    if let Some(truth) = &mut subject.truth {
        truth.pose = Pose::new(2.0, 2.0, 0.0);
        truth.off = Some((3.0, 0.4));
    }
    subject
}

/// A scan with a single place, at the truth.
fn sure() -> Subject {
    places::tests::subject(Pose::new(3.0, 3.0, 1.0))
}

/// Fails if a colour with a meaning is above the legend and not in it.
fn check_legend(scene: &Scene) {
    if scene.width() < 720 {
        // Thin lines of the legend have no pixel of their own colour.
        return;
    }
    // Below all axes.
    let axes = scene.labels().iter().filter(|label| label.text == "x, m");
    let top = axes.map(|label| label.area.bottom()).fold(0.0, f64::max) as u32;
    let png = crate::drawing::to_png(scene).unwrap();
    let picture = image::load_from_memory(&png).unwrap().to_rgb8();
    let classes = theme::CLASSES.map(|class: BeamClass| theme::of_class(class).0);
    let of_maps = [
        theme::OCCUPIED,
        theme::UNKNOWN,
        theme::OUTSIDE,
        theme::BOUNDARY,
    ];
    let of_poses = [theme::BEST, theme::OTHER, theme::TRUTH];
    let colors = classes.into_iter().chain(of_maps).chain(of_poses);
    for color in colors {
        let wanted = image::Rgb([color.red, color.green, color.blue]);
        let found = picture
            .enumerate_pixels()
            .filter(|(.., pixel)| **pixel == wanted);
        let (above, below): (Vec<_>, Vec<_>) = found.partition(|(_, y, _)| *y < top);
        // A single pixel may be a blend of others.
        assert!(
            above.len() < 4 || !below.is_empty(),
            "{color:?} has no name"
        );
    }
}

#[test]
fn a_scan_with_many_places_is_legible_and_all_of_it_is_named() {
    let map = map();
    let ground = ground(&map);
    for width in WIDTHS {
        for (subject, whole) in [(ambiguous(4.0), false), (sure(), false), (sure(), true)] {
            let size = Size { width, whole };
            let scene = scan::draw(&ground, &subject, "a/recording.mcap", size).unwrap();
            layout::check(&scene);
            check_legend(&scene);
        }
    }
}

#[test]
fn all_pictures_of_a_drive_have_the_same_size_and_legend() {
    let map = map();
    let ground = ground(&map);
    let subjects = [sure(), ambiguous(4.0), sure()];
    let size = Size {
        width: 720,
        whole: false,
    };
    let frames = animation::frames(&ground, &subjects, "a/recording.mcap", size);
    let scenes: Vec<Scene> = frames.map(|frame| frame.unwrap().0).collect();
    let legend = |scene: &Scene| {
        let all = layout::texts(scene);
        let first = all.iter().position(|text| text == "path of unique places");
        all.split_at(first.expect("the path is named")).1.to_vec()
    };
    for scene in &scenes {
        check_legend(scene);
        assert_eq!(scene.height(), scenes[0].height());
        assert_eq!(legend(scene), legend(&scenes[0]));
    }
}

#[test]
fn a_map_is_cut_to_what_is_known_and_all_of_it_is_named() {
    let map = map();
    let ground = ground(&map);
    let sides = (map.width as usize, map.height as usize);
    let grid = Grid::new(sides.0, sides.1, &map.cells, ground.rules).unwrap();
    assert!(!boundary::extract(&grid).is_empty());
    for width in WIDTHS {
        let size = Size {
            width,
            whole: false,
        };
        let scene = outline::draw(&ground, &grid, "room.yaml", size).unwrap();
        check_legend(&scene);
        let texts = layout::texts(&scene);
        for name in [
            "boundary cell",
            "obstacle behind it",
            "unknown",
            "x, m",
            "y, m",
        ] {
            assert!(texts.contains(&name.to_owned()), "{name}: {texts:?}");
        }
        // The room begins a metre from the map's edge, and its margin is 0.2 m.
        assert!(!texts.contains(&"beyond the map".to_owned()), "{texts:?}");
    }
}
