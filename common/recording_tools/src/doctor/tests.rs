//! Findings for the recording of the corridor after something in it has been changed.

use std::path::Path;

use ::map::OccupancyGrid;
use recording::write::{Packing, RecordingWriter};
use recording::{Message, Recording};
use ros::{LaserScan, Transform};

use super::checks;
use super::finding::{Finding, Severity};
use super::survey::Survey;

const CORRIDOR: &str = "../../recordings/malaga_corridor/recording.mcap";

fn findings(map: Option<&OccupancyGrid>, change: impl Fn(&mut Message)) -> Vec<Finding> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(CORRIDOR);
    let mut writer = RecordingWriter::in_memory(Packing::Plain).unwrap();
    for record in Recording::open(&path).unwrap().records() {
        let mut record = record.unwrap();
        change(&mut record.message);
        let (topic, time) = (&record.topic, record.log_time_ns);
        writer.write(topic, time, &record.message).unwrap();
    }
    let bytes = writer.finish().unwrap().into_inner();
    let changed = Recording::from_bytes("changed", bytes).unwrap();
    checks::all(&changed, &Survey::of(&changed), map)
}

#[track_caller]
fn check_on(map: Option<&OccupancyGrid>, words: &str, change: impl Fn(&mut Message)) {
    let found = findings(map, change);
    let is_problem = |finding: &Finding| {
        finding.severity == Severity::Problem && finding.finding.contains(words)
    };
    assert!(
        found.len() == 1 && found.iter().all(is_problem),
        "{found:#?}"
    );
}

#[track_caller]
fn check_scans(words: &str, change: impl Fn(&mut LaserScan)) {
    check_on(None, words, |message| {
        if let Message::Scan(scan) = message {
            change(scan);
        }
    });
}

#[track_caller]
fn check_mount(words: &str, change: impl Fn(&mut Transform)) {
    check_on(None, words, |message| {
        if let Message::StaticTransforms(message) = message {
            change(&mut message.transforms[0].transform);
        }
    });
}

#[test]
fn readings_in_millimetres_are_named() {
    check_scans("they are in millimetres", |scan| {
        scan.range_max *= 1000.0;
        scan.ranges.iter_mut().for_each(|range| *range *= 1000.0);
    });
}

#[test]
fn a_time_increment_that_cannot_be_is_named() {
    for (seconds, words) in [
        (1.0, "with a time_increment of 1.0 s"),
        (1e30, "with a time_increment of 1e30 s"),
        (f32::NAN, "time_increment is NaN"),
    ] {
        check_scans(words, |scan| scan.time_increment = seconds);
    }
}

#[test]
fn a_mount_that_is_turned_or_far_away_or_in_walls_is_named() {
    let far = "/tf_static puts \"laser\" 780 m from \"base_link\"";
    check_mount(far, |mount| mount.translation.x *= 1000.0);
    check_mount("degrees to the right of where its mount says", |mount| {
        let half = std::f64::consts::FRAC_1_SQRT_2;
        (mount.rotation.z, mount.rotation.w) = (half, half);
    });
    // The corridor is 3 m wide, and the laser 0.78 m ahead of the base.
    let in_walls = "stands in a wall or off the map at";
    check_mount(in_walls, |mount| mount.translation.y += 9.0);
}

#[test]
fn a_map_of_another_scale_or_place_is_named() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../recordings");
    let corridor = ::map::load(root.join("malaga_corridor/map.yaml")).unwrap();
    for (scale, words) in [
        (1.025, "about 3 % larger than what the laser reads"),
        (0.96, "about 4 % smaller than what the laser reads"),
    ] {
        let scaled = OccupancyGrid {
            resolution_m: corridor.resolution_m * scale,
            ..corridor.clone()
        };
        check_on(Some(&scaled), words, |_| ());
    }
    let courtyard = ::map::load(root.join("malaga_courtyard/map.yaml")).unwrap();
    check_on(Some(&courtyard), "none of 37 scans has a place", |_| ());
}
