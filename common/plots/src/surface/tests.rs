use super::super::layout;
use super::*;

/// Flat but for one corner.
fn relief() -> Relief {
    let mut heights = vec![0.0; 25];
    heights[7] = 1.0;
    Relief {
        columns: 5,
        rows: 5,
        from: (0.0, 0.0),
        longer_m: 5.0,
        heights,
        walls: vec![0.0; 25],
    }
}

#[test]
fn what_is_high_is_up_in_the_picture_from_everywhere() {
    for camera in &CAMERAS {
        let low = camera.look((0.1, 0.2, 0.0));
        let high = camera.look((0.1, 0.2, 0.3));
        assert_eq!(low.at.0, high.at.0);
        assert!(high.at.1 < low.at.1, "{}", camera.name);
        assert_eq!(high.nearness, low.nearness, "{}", camera.name);
    }
}

#[test]
fn from_behind_near_is_what_was_far() {
    let (north, south) = ((0.0, 0.5, 0.0), (0.0, -0.5, 0.0));
    let nearer = |camera: &Camera| camera.look(south).nearness > camera.look(north).nearness;
    assert!(nearer(&CAMERAS[0]) && !nearer(&CAMERAS[1]));
}

#[test]
fn the_summit_is_the_highest_corner_and_patches_come_from_far_to_near() {
    let relief = relief();
    let (x, y, z) = relief.summit().unwrap();
    // Column 2 of row 1, of five around the middle.
    assert!((x + 0.1).abs() < 1e-12 && (y + 0.3).abs() < 1e-12 && z == PEAK);
    let patches = relief.patches(&CAMERAS[0]);
    assert_eq!(patches.len(), 16);
    // On the flat far edge, what is farther is higher up.
    let first = patches.first().map(|(corners, _)| corners[0].1);
    let last = patches.last().map(|(corners, _)| corners[0].1);
    assert!(first < last, "{first:?} {last:?}");
}

#[test]
fn three_axes_are_named_and_their_numbers_stand_beside_each_other() {
    let scale = Axis {
        scale: super::super::scale::Scale::Even(0.0, 1584.0),
        name: "votes",
    };
    for camera in &CAMERAS {
        let heading = page::Heading::plain("votes", "");
        let mut page = Page::new(1200, 560.0, &heading).unwrap();
        let area = page.body;
        draw_from(&mut page, (&relief(), scale), camera, area);
        let names = page.legend.names().join(", ");
        assert_eq!(names, "most votes");
        let texts = layout::texts(&page.finish().unwrap());
        for name in ["x, m", "y, m", "votes", "500", "1500", "2", "4"] {
            let is_there = texts.iter().any(|text| text == name);
            assert!(is_there, "{name}, {}: {texts:?}", camera.name);
        }
    }
}

#[test]
fn the_axis_of_the_height_ends_as_high_as_the_summit() {
    let camera = &CAMERAS[1];
    let relief = relief();
    let room = Rect::new(0.0, 0.0, 800.0, 400.0);
    let space = Space::of(&relief, camera, room);
    let high = |point: (f64, f64, f64)| {
        let (x, y, _) = point;
        space.at((x, y, 0.0)).1 - space.at(point).1
    };
    let summit = high(relief.summit().unwrap());
    // Corners are seen in parallel: the same height is as long everywhere.
    assert!((high((0.5, 0.5, PEAK)) - summit).abs() < 1e-9 && summit > 50.0);
}
