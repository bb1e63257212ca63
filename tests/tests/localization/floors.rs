//! A graph on several maps: one search covers all of them, as in the tools, and the tracker changes
//! maps at transitions.

use std::fs;
use std::path::{Path, PathBuf};

use geometry::{Covariance, Pose};
use messages::{
    Hypothesis, InitialPose, InitialPoseKind, MapSet, Stamp, TrackReason, TrackState, topic,
};
use serde_json::Value;
use tempfile::TempDir;
use tests::executables;
use transport::testing::{Isolated, wait_for};

use super::lost_searches::Robot;
use super::starting_over::truth;

/// Writes a file that names maps of the repository.
fn maps(text: &str) -> (TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let recordings = tests::root().join("recordings");
    let text = text.replace("RECORDINGS", recordings.to_str().unwrap());
    let file = folder.path().join("maps.yaml");
    fs::write(&file, text).unwrap();
    (folder, file)
}

/// Returns the output of `locate` for the recording's scans on these maps.
fn located(maps: &Path, recording: &Path) -> Vec<Value> {
    let mut command = executables::backcast();
    command.args(["locate", "--json", "--maps"]).arg(maps);
    tests::json_lines_of(command.arg(recording))
}

#[test]
fn the_maps_of_a_set_are_searched_as_the_tools_do_and_the_robots_own_is_shown() {
    let (_folder, file) = maps(
        "maps:
  - {name: yard, map: RECORDINGS/malaga_courtyard/map.yaml}
  - {name: corridor, map: RECORDINGS/malaga_corridor/map.yaml, floor: 1}
",
    );
    let isolated = Isolated::new("set");
    let mut robot = Robot::start_on(&isolated, Some(file.clone()));
    let served = robot.graph.subscriber::<topic::Maps>().unwrap();
    let shown = robot.graph.subscriber::<topic::Map>().unwrap();
    let found = robot.graph.subscriber::<topic::Hypotheses>().unwrap();
    let names: Vec<(u64, String)> = wait_for(&robot.graph, &served, |header, items| {
        let set = MapSet::read(header, items).unwrap();
        let names = set
            .maps
            .iter()
            .map(|(map, _)| (map.map_id, map.name.to_string()));
        Some(names.collect())
    });
    let name = |map_id: u64| {
        let named = names.iter().find(|(id, _)| *id == map_id);
        named.map(|(_, name)| &**name).unwrap()
    };
    wait_for(&robot.graph, &shown, |map, _| {
        (map.name.as_str() == "yard").then_some(())
    });

    let scans = robot.world.scans().len();
    let rows = located(&file, &robot.world.recording());
    assert_eq!(rows.len(), scans);
    let mut unique = 0;
    let mut searched = 0;
    for counter in 0..scans as u64 {
        let (pose, _) = robot.pose_after(&robot.send(counter));
        if pose.is_unique() {
            assert_eq!(name(pose.map_id), "corridor");
            let (found, truth) = (Pose::from(pose.map_from_laser), truth(&robot, counter));
            assert!(found.is_within(truth, 0.2, 0.05), "{found:?} {truth:?}");
            unique += 1;
        }
        while let Some(sample) = found.receive().unwrap() {
            let row = &rows[sample.header().stamp.counter as usize];
            is_row(sample.items(), row, &name);
            assert_eq!(name(sample.header().map_id), row["map"]);
            searched += 1;
        }
    }
    assert!(unique > 5 && searched > scans / 2, "{unique} {searched}");
    wait_for(&robot.graph, &shown, |map, _| {
        (map.name.as_str() == "corridor").then_some(())
    });
    robot.stop();
}

/// Checks that the hypotheses of the graph are those of a row of `locate`.
fn is_row<'a>(found: &[Hypothesis], row: &Value, name: &impl Fn(u64) -> &'a str) {
    let rows = row["hypotheses"].as_array().unwrap();
    assert_eq!(found.len(), rows.len(), "{row}");
    for (found, row) in found.iter().zip(rows) {
        assert_eq!(name(found.map_id), row["map"]);
        let Pose { x, y, yaw } = found.map_from_laser.into();
        for (value, key) in [(x, "x"), (y, "y"), (yaw, "yaw")] {
            let expected = row["laser"][key].as_f64().unwrap();
            assert!((value - expected).abs() < 1e-9, "{key}: {value} {expected}");
        }
    }
}

#[test]
fn a_pose_in_a_transition_is_doubtful_and_elsewhere_it_is_not() {
    // The map of one floor is there twice.
    let floors = "maps:
  - {name: ground, map: RECORDINGS/malaga_corridor/map.yaml}
  - {name: first, map: RECORDINGS/malaga_corridor/map.yaml}
transitions:
  - {name: lift, size: [SIDE, SIDE], at: {ground: [X, Y, 0], first: [X, Y, 0]}}
";
    for (number, side) in ["20", "0.01"].into_iter().enumerate() {
        let isolated = Isolated::new(["in-lift", "no-lift"][number]);
        let world = tests::world::World::of("malaga_corridor");
        let start = super::starting_over::truth_of(&world, 0);
        let text = floors.replace("SIDE", side);
        let at = |text: &str, key: &str, value: f64| text.replace(key, &value.to_string());
        let (_folder, file) = maps(&at(&at(&text, "X", start.x + 0.5), "Y", start.y));
        let mut robot = Robot::start_on(&isolated, Some(file));
        let said = robot.graph.publisher::<topic::InitialPoseTopic>().unwrap();
        let header = InitialPose {
            kind: InitialPoseKind::Believed as u64,
            map_from_base: start.into(),
            covariance: Covariance::from_deviations(0.05, 0.05, 0.02).to_rows(),
            stamp: Stamp::default(),
        };
        said.send(header, &[]).unwrap();
        let mut last = None;
        // For later scans there is no odometry: they may be on either floor.
        let scans = [3, 1][number];
        for counter in 0..scans {
            last = Some(robot.pose_after(&robot.send(counter)));
        }
        let (pose, words) = last.unwrap();
        let found = (
            TrackState::from_code(pose.state),
            TrackReason::from_code(pose.reason),
        );
        if number == 0 {
            let expected = (TrackState::Doubtful, TrackReason::SeveralPlaces);
            assert_eq!(found, (Some(expected.0), Some(expected.1)), "{words}");
            assert!(words.starts_with("2 places fit, on 2 maps"), "{words}");
        } else {
            assert_eq!(found.0, Some(TrackState::Unique), "{words}");
        }
        robot.stop();
    }
}
