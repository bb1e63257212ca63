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
