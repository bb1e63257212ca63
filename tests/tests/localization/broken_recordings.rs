//! The tracker believes no wrong pose if odometry, laser or mount are wrong, and needs no more of
//! them than documented.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use geometry::Pose;
use messages::PoseHeader;
use tests::world::World;

use super::tracking::{by_graph, figures};

/// Returns a folder of such recordings.
fn folder(test: &str, name: &str) -> Option<PathBuf> {
    tests::broken_recordings(test).map(|all| all.join(name))
}

/// Returns the poses of a graph with a tracker for each scan of a drive that contains its own map.
fn poses(test: &str, drive: &Path, tracker: &[&str], scans: usize) -> Vec<PoseHeader> {
    // The map of the recording takes precedence over this one.
    let other = World::of("malaga_corridor").map();
    let files = [other.as_path(), drive].map(|file| file.to_str().unwrap());
    let map = ["--map", files[0], "--recorded", files[1]];
    by_graph(test, (drive, &map), ("max", "all"), tracker, scans)
}

#[test]
fn no_start_is_wrong_where_a_sensor_is() {
    let Some(folder) = folder("no_start_is_wrong_where_a_sensor_is", "sure") else {
        return;
    };
    let starts = ["--starts", "12", "--kidnaps", "0", "--outages", "0"];
    let of = |name: &str| figures(&folder.join(format!("{name}.mcap")), &starts);
    let [_, _, chassis] = [
        "courtyard_odometry_stops",
        "frozen_laser",
        "base_called_chassis",
    ]
    .map(|name| {
        let found = of(name);
        assert!(found["starts"].as_u64().unwrap() >= 1, "{name}: {found}");
        assert_eq!(found["wrong_starts"], 0, "{name}: {found}");
        found
    });
    // The name of the base changes nothing.
    let control = of("base_called_base_link_control");
    assert_eq!(chassis["right"], control["right"]);
    // A mirrored laser cannot be detected before it has turned; after that it is not believed.
    let mirrored = of("upside_down_undeclared");
    assert_eq!(mirrored["unique_share"], 0.0, "{mirrored}");
}

#[test]
fn a_covered_laser_is_nowhere() {
    let Some(folder) = folder("a_covered_laser_is_nowhere", "sure") else {
        return;
    };
    for (tag, name) in [
        ("covered-1", "covered_1.0"),
        ("covered-half", "covered_0.5"),
    ] {
        let said = poses(tag, &folder.join(format!("{name}.mcap")), &[], 100);
        assert!(!said.iter().any(PoseHeader::is_unique), "{name}");
    }
}

#[test]
fn a_crowd_that_walks_along_does_not_carry_the_pose_away() {
    let Some(folder) = folder(
        "a_crowd_that_walks_along_does_not_carry_the_pose_away",
        "sure",
    ) else {
        return;
    };
    let text = std::fs::read(folder.join("crowd_walks_along.truth.json")).unwrap();
    let truth: Vec<(i64, [f64; 3])> = serde_json::from_slice(&text).unwrap();
    let truth = BTreeMap::from_iter(truth);
    let said = poses("crowd", &folder.join("crowd_walks_along.mcap"), &[], 170);
    let unique = said.iter().filter(|pose| pose.is_unique());
    let mut count = 0;
    for pose in unique {
        let [x, y, yaw] = truth[&pose.stamp.measured_ns];
        let found = Pose::from(pose.map_from_base);
        let is_there = found.is_within(Pose::new(x, y, yaw), 1.0, 25f64.to_radians());
        assert!(is_there, "{pose:?}");
        count += 1;
    }
    assert!(count > 30, "{count}");
}

#[test]
fn odometry_that_never_moves_is_none() {
    let Some(folder) = folder("odometry_that_never_moves_is_none", "life") else {
        return;
    };
    for (tag, name) in [
        ("odom-rests", "odometry_never_moves"),
        ("odom-dies", "odometry_dies_at_start"),
    ] {
        let said = poses(tag, &folder.join(format!("{name}.mcap")), &[], 170);
        // By the scans alone, the pose is known a metre or two after the start.
        let first = said.iter().position(PoseHeader::is_unique).unwrap();
        assert!(first <= 15, "{name}: {first}");
        let unique = said.iter().filter(|pose| pose.is_unique()).count();
        assert!(unique >= 80, "{name}: {unique}");
    }
}

#[test]
fn a_robot_that_stands_is_found_by_a_hint_or_where_one_scan_is_believed() {
    let Some(folder) = folder(
        "a_robot_that_stands_is_found_by_a_hint_or_where_one_scan_is_believed",
        "life",
    ) else {
        return;
    };
    let drive = folder.join("stands_from_the_start.mcap");
    let said = |tag: &str, tracker: &[&str]| poses(tag, &drive, tracker, 300);
    let unique = |said: &[PoseHeader]| said.iter().filter(|pose| pose.is_unique()).count();
    let alone = said("stands", &[]);
    assert_eq!(unique(&alone), 0);
    let believed = said("stands-sure", &["--start", "believe"]);
    assert!(unique(&believed) >= 299, "{}", unique(&believed));
    let at = Pose::from(believed[0].map_from_base);
    let text = |pose: Pose| format!("{},{},{}", pose.x, pose.y, pose.yaw.to_degrees());
    let hinted = said("stands-hint", &["--initial-pose", &text(at)]);
    assert!(unique(&hinted) >= 299, "{}", unique(&hinted));
    // A wrong hint is not believed.
    let wrong = text(at.then(Pose::new(3.0, 2.0, 1.0)));
    let misled = said("stands-misled", &["--initial-pose", &wrong]);
    assert_eq!(unique(&misled), 0);
}

#[test]
fn point_clouds_are_a_laser() {
    let Some(folder) = folder("point_clouds_are_a_laser", "files") else {
        return;
    };
    let found = tests::json_of(
        tests::executables::backcast()
            .args(["evaluate", "--json", "--cloud-topic", "/velodyne_points"])
            .arg(folder.join("velodyne.mcap")),
    );
    assert_eq!(found["success_20cm_3deg"], 1.0, "{found}");
    assert_eq!(found["unique_wrong"], 0.0, "{found}");
}
