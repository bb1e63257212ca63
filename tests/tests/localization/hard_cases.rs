//! Verdicts on scans that are ambiguous, and on scans that are unique in spite of disturbances.

use engine::peaks::Places;
use engine::vote_search::VoteSearchConfig;
use geometry::Pose;
use messages::Verdict;
use tests::building::{Building, Laser, Rectangle, places};

/// Locates a scan that covers a whole turn on the building's map.
fn locate(building: &Building, ranges: &[f32]) -> Places {
    let localizer = building.map(0.05).localizer(VoteSearchConfig::default());
    places(&localizer, &Laser::AROUND.scan(ranges))
}

fn seen(building: &Building, pose: Pose) -> Vec<f32> {
    building.ranges(pose, Laser::AROUND)
}

fn is_at(place: Pose, expected: Pose) -> bool {
    place.is_within(expected, 0.1, 2f64.to_radians())
}

/// Adds an L: a room whose upper right corner is walled off.
fn l_shaped(building: Building, left: f64, mirrored: bool) -> Building {
    let corner = if mirrored { left + 0.5 } else { left + 4.0 };
    building
        .room([left + 0.5, 0.5, left + 7.0, 5.5])
        .with([corner, 3.0, corner + 3.0, 5.5])
}

#[test]
fn a_room_that_a_half_turn_takes_to_itself_is_ambiguous() {
    let room = Building::new(9.0, 6.0).room([0.5, 0.5, 8.5, 5.5]);
    let pose = Pose::new(3.0, 2.0, 40f64.to_radians());
    let turned = Pose::new(6.0, 4.0, 220f64.to_radians());
    let found = locate(&room, &seen(&room, pose));
    assert_eq!(found.verdict, Verdict::Ambiguous);
    assert_eq!(found.alternatives, 1);
    let best: Vec<Pose> = found.places[..2].iter().map(|p| p.map_from_laser).collect();
    for expected in [pose, turned] {
        assert!(best.iter().any(|&place| is_at(place, expected)), "{best:?}");
    }
    for place in &found.places[..2] {
        assert!((0.4..0.6).contains(&place.probability), "{place:?}");
    }
}

#[test]
fn mirror_images_of_a_room_are_distinguished() {
    let both = l_shaped(l_shaped(Building::new(16.0, 6.0), 0.0, false), 8.0, true);
    for pose in [Pose::new(2.0, 4.0, 0.5), Pose::new(13.5, 4.0, -2.0)] {
        let found = locate(&both, &seen(&both, pose));
        assert_eq!(found.verdict, Verdict::Unique, "{found:?}");
        assert!(is_at(found.places[0].map_from_laser, pose));
        assert!(found.confidence > 0.9);
    }
}

#[test]
fn in_an_endless_corridor_no_place_is_unique() {
    let corridor = Building::new(60.0, 3.0)
        .with([0.0, 0.4, 60.0, 0.5])
        .with([0.0, 2.5, 60.0, 2.6]);
    let pose = Pose::new(30.0, 1.3, 10f64.to_radians());
    let found = locate(&corridor, &seen(&corridor, pose));
    assert_eq!(found.verdict, Verdict::Ambiguous);
    assert!(found.confidence < 0.5);
    // Along the corridor the position is unknown, across it is known.
    let ellipse = found.places[0].covariance.ellipse();
    assert!(ellipse.major_m > 10.0 * ellipse.minor_m, "{ellipse:?}");
    assert!(ellipse.angle.sin().abs() < 0.1, "{ellipse:?}");
}

#[test]
fn people_around_the_robot_do_not_mislead_it() {
    let room = l_shaped(Building::new(8.0, 6.0), 0.0, false);
    let pose = Pose::new(2.0, 4.0, 30f64.to_radians());
    let mut ranges = seen(&room, pose);
    // Legs, three degrees wide, before three beams in ten.
    for (i, range) in ranges.iter_mut().enumerate() {
        if i % 10 < 3 {
            *range = range.min(0.4 + 0.02 * (i / 10) as f32);
        }
    }
    let found = locate(&room, &ranges);
    assert_eq!(found.verdict, Verdict::Unique, "{:?}", found.places[0]);
    assert!(is_at(found.places[0].map_from_laser, pose));
    assert!((0.6..0.8).contains(&found.inlier_share), "{found:?}");
}

#[test]
fn furniture_that_was_moved_does_not_mislead_it() {
    // Ten pieces along the walls of an L-shaped room; every fourth was moved.
    let piece = |i: usize, moved: f64| -> Rectangle {
        let (left, bottom) = match i {
            0..5 => (0.9 + 1.2 * i as f64 + moved, 0.6),
            _ => (0.6, 1.6 + 0.7 * (i - 5) as f64 + moved / 3.0),
        };
        [left, bottom, left + 0.45, bottom + 0.4]
    };
    let room = l_shaped(Building::new(8.0, 6.0), 0.0, false);
    let furnished = |moved: f64| {
        let moved = |i: usize| if i % 4 == 1 { moved } else { 0.0 };
        (0..10).fold(room.clone(), |room, i| room.with(piece(i, moved(i))))
    };
    let (mapped, found) = (furnished(0.0), furnished(0.6));
    for pose in [Pose::new(3.0, 3.5, 1.0), Pose::new(5.5, 2.0, -2.2)] {
        let places = locate(&mapped, &seen(&found, pose));
        assert_eq!(places.verdict, Verdict::Unique, "{:?}", places.places[0]);
        assert!(is_at(places.places[0].map_from_laser, pose));
        assert!(
            places.inlier_share < 0.99,
            "something was moved in its sight"
        );
    }
}

#[test]
fn a_scan_of_a_room_in_an_empty_field_fits_poorly() {
    let room = l_shaped(Building::new(8.0, 6.0), 0.0, false);
    let field = Building::new(30.0, 30.0).with([14.0, 14.0, 14.3, 14.3]);
    let found = locate(&field, &seen(&room, Pose::new(2.0, 4.0, 0.0)));
    assert_eq!(found.verdict, Verdict::PoorFit);
    assert!(found.confidence < 0.1, "{}", found.confidence);
}

#[test]
fn a_scan_without_returns_says_nothing() {
    let room = l_shaped(Building::new(8.0, 6.0), 0.0, false);
    let found = locate(&room, &[f32::INFINITY; 360]);
    assert_eq!(found.verdict, Verdict::NoScan);
    assert!(found.places.is_empty());
}
