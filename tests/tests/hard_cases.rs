//! Scans that cannot tell where they were taken, and scans that can in spite of
//! everything: what the verdict says of them.
#![allow(
    clippy::unwrap_used,
    reason = "the lint spares test functions but not what they share"
)]

use std::f64::consts::PI;

use engine::fit::{Ends, Terrain};
use engine::grid::{CellRules, Grid, GridFrame};
use engine::localizer::{Localizer, LocalizerConfig, Prior};
use engine::peaks::{PeakConfig, PeakInput, Places, by_fit};
use engine::reference;
use engine::scan::Scan;
use geometry::Pose;
use messages::Verdict;

const RESOLUTION_M: f64 = 0.05;

/// A building of straight walls.
struct Building {
    width: usize,
    height: usize,
    occupancy: Vec<u8>,
}

impl Building {
    /// Open space, metres.
    fn new(width_m: f64, height_m: f64) -> Self {
        let cells = |metres: f64| (metres / RESOLUTION_M).round() as usize;
        let (width, height) = (cells(width_m), cells(height_m));
        Building {
            width,
            height,
            occupancy: vec![0; width * height],
        }
    }

    /// Fills a rectangle of obstacle: left, bottom, right and top in metres.
    fn wall(mut self, [left, bottom, right, top]: [f64; 4]) -> Self {
        let cell = |metres: f64| (metres / RESOLUTION_M).round() as usize;
        for y in cell(bottom)..cell(top).min(self.height) {
            for x in cell(left)..cell(right).min(self.width) {
                self.occupancy[y * self.width + x] = 100;
            }
        }
        self
    }

    /// The four walls of a room.
    fn room(self, [left, bottom, right, top]: [f64; 4]) -> Self {
        const THICK: f64 = 0.1;
        self.wall([left, bottom, right, bottom + THICK])
            .wall([left, top - THICK, right, top])
            .wall([left, bottom, left + THICK, top])
            .wall([right - THICK, bottom, right, top])
    }

    fn grid(&self) -> Grid {
        Grid::new(
            self.width,
            self.height,
            &self.occupancy,
            CellRules::default(),
        )
        .unwrap()
    }

    /// What a laser that sees all around to 8 m reads, one beam a degree.
    fn scan(&self, pose: Pose) -> Vec<f32> {
        let (grid, space) = (self.grid(), self.localizer().space().clone());
        let (x, y) = (pose.x / RESOLUTION_M, pose.y / RESOLUTION_M);
        let heading = (pose.yaw.to_degrees().round() as i64).rem_euclid(360) as usize;
        let beams = (0..360).map(|beam| {
            let direction = space.directions.get(heading + 180 + beam);
            let steps = reference::range(&grid, x as i64, y as i64, direction);
            let range = |steps| f64::from(steps) / direction.steps_per_cell * RESOLUTION_M;
            let range = steps.map(range).filter(|&range| range <= 8.0);
            range.map_or(f32::INFINITY, |range| range as f32)
        });
        beams.collect()
    }

    fn localizer(&self) -> Localizer {
        let config = LocalizerConfig::default();
        Localizer::new(FRAME, self.grid(), config, Prior::None).unwrap()
    }

    fn locate(&self, ranges: &[f32]) -> Places {
        let localizer = self.localizer();
        let scan = Scan {
            angle_min: -PI,
            angle_increment: 1f64.to_radians(),
            range_min_m: 0.0,
            range_max_m: 8.0,
            ranges,
        };
        let outcome = localizer.search(&scan, &|| false).unwrap().unwrap();
        let sides = (self.width, self.height);
        let rules = CellRules::default();
        let terrain = Terrain::new(FRAME, sides, &self.occupancy, rules).unwrap();
        let beams = localizer.config().votes.beams;
        let ends = Ends::new(&scan, localizer.space(), &beams).unwrap();
        let input = PeakInput::of(&outcome, FRAME);
        by_fit(&input, (&terrain, &ends), &PeakConfig::default())
    }
}

const FRAME: GridFrame = GridFrame {
    resolution_m: RESOLUTION_M,
    map_from_grid: Pose::IDENTITY,
};

fn is_at(place: Pose, expected: Pose) -> bool {
    place.is_within(expected, 0.1, 2f64.to_radians())
}

/// An L: the upper right corner of a room is walled off.
fn l_shaped(building: Building, left: f64, mirrored: bool) -> Building {
    let corner = if mirrored { left + 0.5 } else { left + 4.0 };
    building
        .room([left + 0.5, 0.5, left + 7.0, 5.5])
        .wall([corner, 3.0, corner + 3.0, 5.5])
}

#[test]
fn a_room_that_a_half_turn_takes_to_itself_is_ambiguous() {
    let room = Building::new(9.0, 6.0).room([0.5, 0.5, 8.5, 5.5]);
    let pose = Pose::new(3.0, 2.0, 40f64.to_radians());
    let turned = Pose::new(6.0, 4.0, 220f64.to_radians());
    let found = room.locate(&room.scan(pose));
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
fn mirror_images_of_a_room_are_told_apart() {
    let both = l_shaped(l_shaped(Building::new(16.0, 6.0), 0.0, false), 8.0, true);
    for pose in [Pose::new(2.0, 4.0, 0.5), Pose::new(13.5, 4.0, -2.0)] {
        let pose = Pose {
            yaw: pose.yaw.to_degrees().round().to_radians(),
            ..pose
        };
        let found = both.locate(&both.scan(pose));
        assert_eq!(found.verdict, Verdict::Unique, "{found:?}");
        assert!(is_at(found.places[0].map_from_laser, pose));
        assert!(found.confidence > 0.9);
    }
}

#[test]
fn in_an_endless_corridor_no_place_is_unique() {
    let corridor = Building::new(60.0, 3.0)
        .wall([0.0, 0.4, 60.0, 0.5])
        .wall([0.0, 2.5, 60.0, 2.6]);
    let pose = Pose::new(30.0, 1.3, 10f64.to_radians());
    let found = corridor.locate(&corridor.scan(pose));
    assert_eq!(found.verdict, Verdict::Ambiguous);
    assert!(found.confidence < 0.5);
    // Along the corridor it might be anywhere, across it is known.
    let ellipse = found.places[0].covariance.ellipse();
    assert!(ellipse.major_m > 10.0 * ellipse.minor_m, "{ellipse:?}");
    assert!(ellipse.angle.sin().abs() < 0.1, "{ellipse:?}");
}

#[test]
fn people_around_the_robot_do_not_mislead_it() {
    let room = l_shaped(Building::new(8.0, 6.0), 0.0, false);
    let pose = Pose::new(2.0, 4.0, 30f64.to_radians());
    let mut ranges = room.scan(pose);
    // Legs, three degrees wide, before three beams in ten.
    for (i, range) in ranges.iter_mut().enumerate() {
        if i % 10 < 3 {
            *range = range.min(0.4 + 0.02 * (i / 10) as f32);
        }
    }
    let found = room.locate(&ranges);
    assert_eq!(found.verdict, Verdict::Unique, "{:?}", found.places[0]);
    assert!(is_at(found.places[0].map_from_laser, pose));
    assert!((0.6..0.8).contains(&found.inlier_share), "{found:?}");
}

#[test]
fn a_scan_of_a_room_in_an_empty_field_fits_poorly() {
    let room = l_shaped(Building::new(8.0, 6.0), 0.0, false);
    let field = Building::new(30.0, 30.0).wall([14.0, 14.0, 14.3, 14.3]);
    let found = field.locate(&room.scan(Pose::new(2.0, 4.0, 0.0)));
    assert_eq!(found.verdict, Verdict::PoorFit);
    assert!(found.confidence < 0.1, "{}", found.confidence);
}

#[test]
fn a_scan_without_returns_says_nothing() {
    let room = l_shaped(Building::new(8.0, 6.0), 0.0, false);
    let found = room.locate(&[f32::INFINITY; 360]);
    assert_eq!(found.verdict, Verdict::NoScan);
    assert!(found.places.is_empty());
}
