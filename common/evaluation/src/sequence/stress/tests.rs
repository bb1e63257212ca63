use ::map::OccupancyGrid;
use bytemuck::Zeroable;
use geometry::Pose;
use messages::{Odometry, Stamp};
use offline::TakenScan;
use ros::LaserScan;
use simulation::Obstacles;

use super::material::{Material, Step};
use super::variants::{Stress, Variant, Way};

const BEAMS: usize = 181;

fn other_map() -> OccupancyGrid {
    OccupancyGrid::from_parts(2, 1, 0.05, Pose::IDENTITY, vec![0, 100]).unwrap()
}

/// A room of 20 by 8 m with a pillar, and a drive of 8 m through it.
fn material() -> Material {
    let (width, height) = (400, 160);
    let cells = (0..width * height).map(|i| {
        let (x, y) = (i % width, i / width);
        let is_edge = x < 2 || y < 2 || x >= width - 2 || y >= height - 2;
        let is_pillar = (150..154).contains(&x) && (120..124).contains(&y);
        100 * u8::from(is_edge || is_pillar)
    });
    let map = OccupancyGrid::from_parts(width, height, 0.05, Pose::IDENTITY, cells.collect());
    let map = map.unwrap();
    let obstacles = Obstacles::of(&map);
    let step = |i: i32| {
        let pose = Pose::new(4.0 + 0.2 * f64::from(i), 4.0, 0.3);
        let increment = std::f64::consts::PI / (BEAMS - 1) as f64;
        let range = |beam: usize| {
            let angle = pose.yaw - std::f64::consts::FRAC_PI_2 + beam as f64 * increment;
            obstacles.range(pose.x, pose.y, angle, 30.0).unwrap() as f32
        };
        Step {
            scan: TakenScan {
                stamp_ns: i64::from(i) * 1_000_000_000,
                log_time_ns: i64::from(i) * 1_000_000_000,
                base_from_laser: None,
                upside_down: false,
                message: LaserScan {
                    angle_min: -std::f32::consts::FRAC_PI_2,
                    angle_max: std::f32::consts::FRAC_PI_2,
                    angle_increment: increment as f32,
                    range_max: 30.0,
                    ranges: (0..BEAMS).map(range).collect(),
                    ..LaserScan::default()
                },
                laser: String::new(),
                others: Vec::new(),
            },
            truth: Some(pose),
            map_from_laser: pose,
            gone_m: 0.2 * f64::from(i),
        }
    };
    let steps: Vec<Step> = (0..41).map(step).collect();
    let odometry = steps.iter().map(|step| Odometry {
        stamp: Stamp::measured_at(step.scan.stamp_ns),
        odom_from_child: step.map_from_laser.into(),
        ..Odometry::zeroed()
    });
    Material {
        odometry: odometry.collect(),
        map,
        steps,
        is_nowhere: false,
        starts_until_m: f64::INFINITY,
    }
}

/// Applies a variant to the room; `None` if it changes no material.
fn made(variant: &Variant, seed: u64) -> Option<Material> {
    let (mut material, other) = (material(), other_map());
    let mut means = variant.means(seed, Some(&other));
    match variant.way {
        Way::Drive(change) => change(&mut material, &mut means).ok()?,
        Way::Odometry(change) => change(&mut material.odometry),
        Way::Undisturbed | Way::Moments(_) => return None,
    }
    Some(material)
}

fn scans(material: &Material) -> Vec<&TakenScan> {
    material.steps.iter().map(|step| &step.scan).collect()
}

fn all() -> Vec<&'static Variant> {
    "all".parse::<Stress>().unwrap().variants()
}

#[test]
fn every_name_and_group_is_read_and_others_are_refused() {
    for variant in all() {
        let found = variant.name.parse::<Stress>().unwrap().variants();
        let found: Vec<&str> = found.iter().map(|variant| variant.name).collect();
        assert_eq!(found, [variant.name]);
    }
    let groups = ["undisturbed", "map", "laser", "odometry", "motion"];
    let of = |name: &str| name.parse::<Stress>().unwrap().variants().len();
    assert_eq!(groups.map(of).iter().sum::<usize>(), all().len());
    assert_eq!(of("map-drawn,view-60"), 2);
    let error = "view-61".parse::<Stress>().unwrap_err();
    assert!(
        error.contains("view-61") && error.contains("map-drawn"),
        "{error}"
    );
}

#[test]
fn a_seed_decides_all_of_a_variant() {
    let mut by_seed = 0;
    for variant in all() {
        let [a, b, c] = [1, 1, 2].map(|seed| made(variant, seed));
        let (Some(a), Some(b), Some(c)) = (a, b, c) else {
            continue;
        };
        let is_same = |a: &Material, b: &Material| {
            // Readings may be infinite, but are never NaN here.
            a.map == b.map && a.odometry == b.odometry && scans(a) == scans(b)
        };
        assert!(is_same(&a, &b), "{}", variant.name);
        by_seed += u32::from(!is_same(&a, &c));
    }
    // Erasing, furniture, covering, noise, people, glass, short returns, standing.
    assert_eq!(by_seed, 13);
}

#[test]
fn each_variant_changes_what_it_names_and_nothing_else() {
    let before = material();
    for variant in all() {
        let Some(after) = made(variant, 1) else {
            continue;
        };
        let name = variant.name;
        let changed = [
            after.map != before.map,
            scans(&after) != scans(&before),
            after.odometry != before.odometry,
        ];
        let expected = match name.split('-').next() {
            Some("map") | Some("starts") => [true, false, false],
            Some("odometry") => [false, false, true],
            Some("stands") => [false, true, true],
            _ => [false, true, false],
        };
        assert_eq!(changed, expected, "{name}");
        let is_nowhere = ["map-mirrored", "map-other", "laser-mirrored"].contains(&name);
        assert_eq!(after.is_nowhere, is_nowhere, "{name}");
    }
}

#[test]
fn shares_are_those_of_the_names() {
    let before = material();
    let made = |name: &str| {
        let variants = name.parse::<Stress>().unwrap().variants();
        made(variants[0], 1).unwrap()
    };
    let walls = |it: &Material| it.map.cells.iter().filter(|&&cell| cell == 100).count() as f64;
    for (name, share) in [("map-erased-10", 0.1), ("map-erased-30", 0.3)] {
        let erased = 1.0 - walls(&made(name)) / walls(&before);
        // The last disc may erase up to 80 of 2200 cells too many.
        assert!((share..share + 0.04).contains(&erased), "{name}: {erased}");
    }
    let hidden = |name: &str| {
        let after = made(name);
        let pairs = scans(&before).into_iter().zip(scans(&after));
        let beams = pairs.flat_map(|(a, b)| a.message.ranges.iter().zip(&b.message.ranges));
        let changed = beams.filter(|(a, b)| a != b).count();
        changed as f64 / (before.steps.len() * BEAMS) as f64
    };
    assert!((0.17..0.25).contains(&hidden("people-standing-20")));
    assert!((0.40..0.52).contains(&hidden("people-standing-45")));
    let share = hidden("crowd-walks");
    assert!((0.60..0.92).contains(&share), "{share}");
    assert!((0.08..0.12).contains(&hidden("short-returns")));
    assert_eq!(made("beams-61").steps[0].scan.message.ranges.len(), 61);
    assert_eq!(made("view-90").steps[0].scan.message.ranges.len(), 91);
    // The pillar of 0.2 m is gone, and the walls are still there.
    let drawn = made("map-drawn").map;
    assert_eq!(drawn.cells[121 * 400 + 151], 0);
    assert!(drawn.cells.iter().filter(|&&cell| cell == 100).count() > 500);
}
