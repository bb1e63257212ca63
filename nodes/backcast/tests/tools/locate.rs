//! Tests of `backcast locate` as a process, on drawn and on real recordings.

use std::fs::File;
use std::io::Read;

use geometry::Pose;
use serde_json::Value;

use crate::drawn::{
    BASE_FROM_LASER, HERE, ODOMETRY_OFFSET_DEG, RESOLUTION_M, SECOND_NS, THERE, backcast, folder,
    lines, map_from_laser, map_message, mount_message, objects, odometry_at, room, run, scan_at,
    truth_at, word,
};

fn pose(object: &Value) -> Pose {
    let number = |key: &str| object[key].as_f64().unwrap();
    Pose::new(number("x"), number("y"), number("yaw"))
}

/// Asserts that poses agree within a cell and a heading step, the accuracy of the search.
#[track_caller]
fn assert_near(found: Pose, expected: Pose) {
    let near = found.is_within(expected, RESOLUTION_M, 1.5f64.to_radians());
    assert!(near, "{found:?} {expected:?}");
}

#[test]
fn a_row_for_each_scan_under_the_columns_of_run() {
    let folder = folder(&[map_message(), scan_at(7, HERE), scan_at(8, THERE)]);
    let lines = lines(folder.path(), "");
    assert_eq!(
        lines[0],
        "       stamp s  laser x m  laser y m  heading deg  score  verdict    alternatives        ms"
    );
    assert_eq!(lines.len(), 3);
    for (row, (stamp, place)) in lines[1..].iter().zip([("7.000", HERE), ("8.000", THERE)]) {
        assert_eq!(word(row, 0), stamp);
        let number = |column| word(row, column).parse::<f64>().unwrap();
        let found = Pose::new(number(1), number(2), number(3).to_radians());
        assert_near(found, map_from_laser(place));
        // Rays end at the face of a wall, up to half a cell before its middle.
        assert!(number(4) > 0.9, "every beam agrees: {row}");
        assert_eq!((word(row, 5), word(row, 6)), ("Unique".into(), "0".into()));
        assert!(number(7) > 0.0, "computing costs");
        assert_eq!(row.split_whitespace().count(), 8);
    }
}

#[test]
fn poses_are_searched_within_limits() {
    let folder = folder(&[map_message(), scan_at(7, HERE)]);
    let here = map_from_laser(HERE);
    let found = |limits: &str| pose(&objects(folder.path(), limits)[0]["laser"]);
    let around = |Pose { x, y, .. }| {
        let (left, bottom, right, top) = (x - 0.3, y - 0.3, x + 0.3, y + 0.3);
        found(&format!("--region '{left},{bottom} {right},{top}'"))
    };
    let turned = |from: f64, to: f64| {
        let degrees = here.yaw.to_degrees();
        found(&format!(
            "--headings-within {},{}",
            degrees + from,
            degrees + to
        ))
    };
    assert_near(around(here), here);
    assert_near(turned(-5.0, 5.0), here);
    // The other place is 2.3 m away, more than refining moves a pose.
    let elsewhere = around(map_from_laser(THERE));
    assert!(elsewhere.distance_to(here) > 1.0, "{elsewhere:?}");
    let turned = turned(100.0, 170.0);
    assert!(turned.angle_to(here) > 60f64.to_radians(), "{turned:?}");
    // The pillar is three cells of 0.25 m away, and the walls are at least as far.
    assert_near(found("--robot-radius 0.7"), here);
}

#[test]
fn limits_that_leave_no_pose_are_refused() {
    let folder = folder(&[map_message(), scan_at(7, HERE)]);
    for (limits, expected) in [
        ("--region '100,100 101,101'", "no open cell of the map"),
        ("--robot-radius 4", "the robot's radius"),
        ("--headings-within 10", "needed is FROM,TO in degrees"),
        ("--region 1,2", "1 corners; allowed are 2 to 1000"),
    ] {
        let (code, _, error) = run(folder.path(), &format!("locate --bag r.mcap {limits}"));
        assert!(code != 0 && error.contains(expected), "{limits}: {error}");
    }
}

#[test]
fn an_object_shows_votes_and_hypotheses() {
    let folder = folder(&[map_message(), mount_message(), scan_at(7, HERE)]);
    let object = &objects(folder.path(), "")[0];
    assert_eq!(object["stamp_ns"], 7 * SECOND_NS);
    assert_eq!(object["map_id"], format!("{:016x}", room().id()));
    assert_eq!(object["verdict"], "Unique");
    assert_eq!(object["refused"], Value::Null);
    let votes = &object["votes"];
    let beams = object["beams"].as_object().unwrap();
    let all: u64 = beams.values().map(|count| count.as_u64().unwrap()).sum();
    assert_eq!(all, votes["beams_used"].as_u64().unwrap());
    assert_eq!(votes["best"], votes["highest_possible"]);
    assert_eq!(votes["headings"], 360);
    assert_eq!(votes["known_heading"], Value::Null);
    let best = &object["hypotheses"][0];
    for key in "map_id map laser base base_covariance score probability".split(' ') {
        assert_eq!(best[key], object[key], "{key}");
    }
    for key in ["laser_covariance", "base_covariance"] {
        assert_eq!(best[key].as_array().unwrap().len(), 9);
    }
    assert_eq!(best["intensity"], votes["best"]);
    let laser = pose(&best["laser"]);
    assert_near(laser, map_from_laser(HERE));
    // The same transforms in another order: they agree up to a few units in the last place.
    let base = pose(&best["base"]);
    assert!(base.then(BASE_FROM_LASER).is_within(laser, 1e-9, 1e-9));
}

#[test]
fn particles_gather_around_the_place_the_same_with_a_seed() {
    let folder = folder(&[map_message(), mount_message(), scan_at(7, HERE)]);
    let asked = |options: &str| objects(folder.path(), options)[0]["particles"].clone();
    assert_eq!(asked(""), Value::Null);
    let particles = asked("--particles 50");
    assert_eq!(particles, asked("--particles 50 --particles-seed 1"));
    assert_ne!(particles, asked("--particles 50 --particles-seed 2"));
    assert_eq!(particles["laser"], Value::Null);
    let poses = particles["base"].as_array().unwrap();
    assert_eq!(poses.len(), 50);
    let base = map_from_laser(HERE).then(BASE_FROM_LASER.inverse());
    for particle in poses {
        // A unique place spreads by half a cell and a degree, half a metre from the laser.
        assert!(pose(particle).is_within(base, 1.0, 0.2), "{particle}");
    }
    let lines = lines(folder.path(), "--particles 2");
    assert_eq!(lines.len(), 4, "{lines:?}");
    assert!(
        lines[2].trim_start().starts_with("particle of the base"),
        "{lines:?}"
    );
}

#[test]
fn the_map_that_is_named_goes_before_the_one_in_the_recording() {
    let folder = folder(&[map_message(), scan_at(1, HERE)]);
    let wider = map::OccupancyGrid {
        map_from_grid: Pose::new(100.0, 0.0, 0.0),
        ..room()
    };
    map::save(&wider, folder.path().join("other.yaml")).unwrap();
    map::save(&room(), folder.path().join("same.yaml")).unwrap();
    let other = &objects(folder.path(), "--map other.yaml")[0];
    assert!(other["laser"]["x"].as_f64().unwrap() > 99.0);
    let [inside, same, recorded] = ["", "--map same.yaml", "--map r.mcap"]
        .map(|options| objects(folder.path(), options).remove(0));
    for found in [same, recorded] {
        assert_eq!(found["map_id"], inside["map_id"]);
        assert_eq!(found["votes"], inside["votes"]);
        assert_eq!(found["hypotheses"], inside["hypotheses"]);
    }
}

#[test]
fn a_key_of_a_map_that_is_not_known_is_named_and_the_map_is_used() {
    let folder = folder(&[scan_at(1, HERE)]);
    let yaml = folder.path().join("room.yaml");
    map::save(&room(), &yaml).unwrap();
    let text = std::fs::read_to_string(&yaml).unwrap();
    std::fs::write(&yaml, format!("{text}frame_id: map\n")).unwrap();
    let (code, found, said) = run(folder.path(), "locate --json --bag r.mcap --map room.yaml");
    assert_eq!((code, found.lines().count()), (0, 1), "{said}");
    assert!(said.contains("the key frame_id is not known"), "{said}");
}

#[test]
fn a_known_heading_comes_from_where_it_is_said_to() {
    let folder = folder(&[
        map_message(),
        mount_message(),
        odometry_at(1, HERE),
        truth_at(1, HERE),
        scan_at(1, HERE),
        odometry_at(2, THERE),
        scan_at(2, THERE),
        scan_at(60, THERE),
    ]);
    let truths = [HERE, THERE].map(map_from_laser);
    let fixed = format!("--heading {}", truths[0].yaw.to_degrees());
    let odometry = format!("--heading-from odometry --heading-offset {ODOMETRY_OFFSET_DEG}");
    for (options, answered) in [
        (fixed, 1),
        (odometry, 2),
        ("--heading-from truth".into(), 1),
    ] {
        let objects = objects(folder.path(), &options);
        for (object, truth) in objects.iter().zip(truths).take(answered) {
            let best = pose(&object["laser"]);
            assert_near(best, truth);
            // One rotation and a few sums: the given heading is kept up to rounding.
            assert!(best.angle_to(truth) < 1e-9, "{options}");
            assert_eq!(object["votes"]["known_heading"], best.yaw);
        }
        assert_eq!(objects.len(), 3);
    }
    let reason = |options, scan: usize| {
        let object = &objects(folder.path(), options)[scan];
        object["refused"].as_str().unwrap().to_owned()
    };
    assert_eq!(
        reason("--heading-from truth", 1),
        "the heading is to come from the ground truth, but none is known that was measured at 2000000000 ns"
    );
    let old = reason("--heading-from odometry", 2);
    assert!(
        old.contains("measured 58000000000 ns before the scan"),
        "{old}"
    );
}

#[test]
fn settings_reach_the_engine() {
    let folder = folder(&[map_message(), scan_at(1, HERE)]);
    let votes = |options| objects(folder.path(), options)[0]["votes"].clone();
    assert_eq!(votes("--max-beams 60")["beams_used"], 60);
    assert_eq!(votes("--headings 720")["headings"], 720);
    assert_eq!(votes("--max-votes 1 --candidates 0")["total"], 1);
    let verdict = |options| objects(folder.path(), options)[0]["verdict"].clone();
    assert_eq!(verdict(""), "Unique");
    assert_eq!(verdict("--floor-share 0.3 --unique-from 1"), "Ambiguous");
    assert_eq!(verdict("--least-score 1"), "PoorFit");
    let many = objects(folder.path(), "--floor-share 0.3 --max-hypotheses 5").remove(0);
    assert_eq!(many["hypotheses"].as_array().unwrap().len(), 5);
    let blocked = objects(
        folder.path(),
        "--occupied-from 100 --free-to 0 --unknown-blocks",
    );
    assert_eq!(blocked[0]["verdict"], "Unique");
}

#[test]
fn a_reader_that_went_away_ends_it_well() {
    let folder = folder(&[map_message(), scan_at(1, HERE), scan_at(2, HERE)]);
    let mut child = backcast(folder.path(), "locate --bag r.mcap")
        .spawn()
        .unwrap();
    drop(child.stdout.take());
    let output = child.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(0));
    assert_eq!(output.stderr, b"");
}

#[test]
fn on_a_terminal_there_is_a_bar() {
    let folder = folder(&[map_message(), scan_at(1, HERE), scan_at(2, HERE)]);
    let terminal = nix::pty::openpty(None, None).unwrap();
    let mut command = backcast(folder.path(), "locate --bag r.mcap");
    command.env("TERM", "xterm").stderr(terminal.slave);
    let child = command.spawn().unwrap();
    // Reading the terminal ends when the last copy of its other end is closed.
    drop(command);
    let mut shown = Vec::new();
    let mut buffer = [0; 4096];
    let mut master = File::from(terminal.master);
    while let Ok(length @ 1..) = master.read(&mut buffer) {
        shown.extend_from_slice(&buffer[..length]);
    }
    let output = child.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(0));
    let shown = String::from_utf8_lossy(&shown);
    assert!(shown.contains("locating"), "{shown:?}");
    assert!(shown.contains("/2 scans"), "{shown:?}");
    let rows = String::from_utf8(output.stdout).unwrap();
    assert_eq!(rows.lines().count(), 3, "the rows are not in the bar's way");
}
