//! Tests of the node as a process: scans, odometry and search results go in, poses come out.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod world;

use std::time::Duration;

use messages::{InitialPoseKind, TrackState, topic};
use tests::drawn_map::DrawnMap;
use transport::testing::{Isolated, wait_until};

use world::{HALL, Step, World, drawn, ids, searched, with_a_box};

#[test]
fn a_pose_that_nobody_searched_for_is_not_unique() {
    let isolated = Isolated::new("refused");
    let hall = drawn("", &HALL);
    let world = World::of_map(&isolated, &hall);
    let start = world.pose_at(6);
    let hint = format!("{},{},0", start.x, start.y);
    let node = world.start(&["--initial-pose", &hint]);
    let id = hall.header.map_id;
    // The scan was refused, or another map was searched.
    for number in 0..8 {
        let of = [0, id ^ 1][number % 2];
        let Step {
            pose, was_asked, ..
        } = world.step(6 + 2 * number, of, None);
        assert!(was_asked && !pose.is_unique(), "{number}: {pose:?}");
    }
    // A search without results still counts as a search.
    assert!(world.is_found(&[22, 24, 26], id, None));
    node.stop();
}

#[test]
fn what_was_found_by_other_settings_is_left_out_and_the_settings_are_named() {
    let isolated = Isolated::new("settings");
    let hall = drawn("", &HALL);
    let world = World::of_map(&isolated, &hall);
    let health = isolated.join("watcher");
    let reports = health.subscriber::<topic::Health>().unwrap();
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("localization.yaml");
    std::fs::write(&file, "max_beams: 90\n").unwrap();
    let node = world.start(&["--settings", file.to_str().unwrap()]);
    let id = hall.header.map_id;
    for x in [6, 8, 10, 12, 14] {
        let pose = world.step(x, id, Some(id)).pose;
        assert_eq!(pose.state, TrackState::Searching as u32, "{pose:?}");
    }
    wait_until(&health, &reports, |_, error| {
        let error = String::from_utf8_lossy(error);
        error.contains("read scans by other settings") && error.contains("--settings FILE")
    });
    node.stop();
}

#[test]
fn a_file_of_the_last_pose_that_cannot_be_used_is_named_and_the_robot_is_searched() {
    let isolated = Isolated::new("remember");
    let hall = drawn("", &HALL);
    let world = World::of_map(&isolated, &hall);
    let health = isolated.join("watcher");
    let reports = health.subscriber::<topic::Health>().unwrap();
    let folder = tempfile::tempdir().unwrap();
    let id = hall.header.map_id;
    let cut = folder.path().join("pose.json");
    std::fs::write(&cut, "{\"map_id\":").unwrap();
    for (file, kept) in [(&*cut, true), (folder.path(), false)] {
        let node = world.start(&["--remember", file.to_str().unwrap()]);
        wait_until(&health, &reports, |_, error| {
            let error = String::from_utf8_lossy(error);
            error.contains("the robot is searched everywhere") && error.contains("the last pose in")
        });
        let columns: Vec<usize> = (6..30).step_by(2).collect();
        assert!(world.is_found(&columns, id, Some(id)), "{file:?}");
        match kept {
            true => node.stop(),
            // A failure to write at the end gives a non-zero exit code.
            false => {
                node.interrupt();
                assert_eq!(node.exit_code(), Some(1));
            }
        }
        assert_eq!(file.is_file(), kept);
    }
    let saved = std::fs::read_to_string(&cut).unwrap();
    assert!(saved.contains("map_from_base"), "{saved}");
}

fn floors() -> Vec<DrawnMap> {
    vec![drawn("ground", &HALL), drawn("first", &HALL)]
}

fn edited(number: usize) -> Vec<DrawnMap> {
    let mut floors = floors();
    floors[number] = drawn(floors[number].header.name.as_str(), &with_a_box());
    floors
}

#[test]
fn what_was_found_on_the_set_before_makes_no_pose_unique() {
    let isolated = Isolated::new("old-set");
    let world = World::of_set(&isolated, &floors());
    let node = world.start(&[]);
    let before = searched(&floors());
    let ground = ids(&floors())[0];
    assert!(world.is_found(&[6, 8, 10, 12], before, Some(ground)));
    world.serve_set(&edited(1));
    // The search still uses the old maps until all new ones are prepared.
    for x in [14, 16, 18, 20, 22] {
        let Step {
            pose, was_asked, ..
        } = world.step(x, before, Some(ground));
        assert!(was_asked && !pose.is_unique(), "{x}: {pose:?}");
    }
    let now = searched(&edited(1));
    assert!(world.is_found(&[24, 26, 28], now, Some(ground)));
    node.stop();
}

#[test]
fn what_is_said_of_the_pose_is_about_the_map_that_is_shown() {
    let isolated = Isolated::new("shown");
    let world = World::of_set(&isolated, &floors());
    let node = world.start(&[]);
    let searched = searched(&floors());
    let [ground, first] = ids(&floors())[..] else {
        unreachable!("there are two floors");
    };
    // The other floor leads, but not for long enough to be displayed.
    let pose = world.step(6, searched, Some(first)).pose;
    assert_eq!((pose.map_id, pose.is_unique()), (first, false));
    world.say(InitialPoseKind::Believed, 8);
    let pose = world.step(8, searched, None).pose;
    assert_eq!((pose.map_id, pose.is_unique()), (ground, true));
    world.serve_map(&floors()[1]);
    world.say(InitialPoseKind::Believed, 10);
    let pose = world.step(10, searched, None).pose;
    assert_eq!((pose.map_id, pose.is_unique()), (first, true));
    node.stop();
}

#[test]
fn a_robot_without_a_place_stays_on_its_map() {
    let isolated = Isolated::new("no-place");
    let world = World::of_set(&isolated, &floors());
    let node = world.start(&[]);
    let first = ids(&floors())[1];
    let pose = world.step(6, searched(&floors()), Some(first)).pose;
    assert_eq!((pose.map_id, pose.is_unique()), (first, false));
    world.serve_set(&edited(0));
    let pose = world.step(8, 0, None).pose;
    assert_eq!((pose.map_id, pose.pose_known), (first, 0));
    node.stop();
}

#[test]
fn a_pose_on_a_floor_that_was_edited_is_tried_and_the_old_one_goes_out_no_more() {
    let isolated = Isolated::new("edited");
    let world = World::of_set(&isolated, &floors());
    let node = world.start(&[]);
    world.serve_map(&floors()[1]);
    world.say(InitialPoseKind::Believed, 6);
    let pose = world.step(6, searched(&floors()), None).pose;
    assert!(pose.is_unique());
    /// Half a second, in which the robot moves by half a step.
    const HALF: i64 = 500_000_000;
    let pause = || std::thread::sleep(Duration::from_millis(50));
    // Odometry extrapolates the pose.
    pause();
    world.send_odometry(7, HALF);
    pause();
    assert!(!world.step(8, 0, None).carried.is_empty());
    world.serve_set(&edited(1));
    pause();
    world.send_odometry(9, HALF);
    pause();
    let Step { pose, carried, .. } = world.step(10, 0, None);
    assert!(carried.is_empty(), "{carried:?}");
    let first = ids(&edited(1))[1];
    assert_eq!((pose.map_id, pose.pose_known), (first, 1));
    assert!(!pose.is_unique());
    node.stop();
}
