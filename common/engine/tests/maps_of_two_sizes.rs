//! A hall and a closet that are searched together: beams too long for the closet count against it.
#![allow(
    clippy::unwrap_used,
    reason = "the lint spares test functions but not what they share"
)]

use engine::Map;
use engine::localizer::{Localizer, PreparedMap, Settings, Workspace};
use engine::scan::Scan;
use geometry::Pose;

const CELL_M: f64 = 0.1;

/// A map with sides in metres and a function that tells its inner walls.
struct Room {
    sides_m: (f64, f64),
    is_inner_wall: fn(f64, f64) -> bool,
}

/// A hall with a screen of two metres, and pillars that make it asymmetric.
const HALL: Room = Room {
    sides_m: (30.0, 20.0),
    is_inner_wall: |x, y| {
        let screen = (10.0..12.0).contains(&x) && (8.0..8.2).contains(&y);
        let pillars = [(3.0, 15.0), (22.0, 5.0), (17.0, 13.0)];
        screen || pillars.iter().any(|p| (x - p.0).hypot(y - p.1) < 0.5)
    },
};

const CLOSET: Room = Room {
    sides_m: (3.0, 3.0),
    is_inner_wall: |_, _| false,
};

impl Room {
    fn is_wall(&self, x: f64, y: f64) -> bool {
        let (width, height) = self.sides_m;
        let is_inside = |at: f64, side: f64| at >= CELL_M && at < side - CELL_M;
        !(is_inside(x, width) && is_inside(y, height)) || (self.is_inner_wall)(x, y)
    }

    fn prepared(&self) -> PreparedMap {
        let sides = [self.sides_m.0, self.sides_m.1].map(|m| (m / CELL_M).round() as usize);
        let middle = |i: usize| (i as f64 + 0.5) * CELL_M;
        let cells = (0..sides[0] * sides[1]).map(|i| {
            let (x, y) = (middle(i % sides[0]), middle(i / sides[0]));
            100 * u8::from(self.is_wall(x, y))
        });
        let cells = cells.collect::<Vec<_>>();
        let map = Map::new(CELL_M, Pose::IDENTITY, sides.into(), &cells);
        PreparedMap::new(map, Settings::default()).unwrap()
    }

    /// Ranges of a 270° laser at a pose, with people in every fourth of the long beams.
    fn ranges(&self, pose: Pose) -> Vec<f32> {
        let beams = (0..180).map(|beam| {
            let bearing = f64::from(beam) * 1.5 - 135.0;
            let (sin, cos) = (pose.yaw + bearing.to_radians()).sin_cos();
            let steps = (1..).map(|step| 0.01 * f64::from(step));
            let mut walls = steps.filter(|r| self.is_wall(pose.x + r * cos, pose.y + r * sin));
            let range = walls.next().unwrap();
            let is_short = beam % 4 == 0 && range > 6.0;
            range as f32 * if is_short { 0.75 } else { 1.0 }
        });
        beams.collect()
    }
}

#[test]
fn what_a_closet_is_too_small_for_speaks_against_it() {
    let (hall, closet) = (HALL.prepared(), CLOSET.prepared());
    let sets = [
        (0, vec![hall.clone(), closet.clone()]),
        (1, vec![closet, hall]),
    ];
    let mut workspace = Workspace::default();
    for (hall, maps) in sets {
        let localizer = Localizer::of_maps(maps).unwrap();
        for step in 0..5 {
            // The robot drives along the screen, which is most of what is nearby.
            let pose = Pose::new(
                10.6 + 0.2 * f64::from(step),
                6.8,
                1.5 + 0.03 * f64::from(step),
            );
            let ranges = HALL.ranges(pose);
            let scan = Scan {
                angle_min: (-135f64).to_radians(),
                angle_increment: 1.5f64.to_radians(),
                range_min_m: 0.1,
                range_max_m: 40.0,
                ranges: &ranges,
            };
            let found = localizer.locate(&mut workspace, &scan).unwrap();
            let best = &found.places.places[0];
            assert_eq!(best.map, hall, "{best:?}");
            assert!(
                best.map_from_laser.is_within(pose, 0.15, 0.03),
                "{best:?} {pose:?}"
            );
        }
    }
}
