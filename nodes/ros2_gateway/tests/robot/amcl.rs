//! In AMCL's place, with a tracker that the test plays.

use std::path::Path;

use messages::{InitialPose, InitialPoseKind};

use super::client::{active, ask, of_scan, set_initial_pose, settle, state, subscribe, until_now};
use super::tracked::send_pose;
use super::*;

/// Returns a stamp of no scan, at milliseconds of the robot's clock.
fn stamp(ms: i64) -> Stamp {
    transport::stamp_now(1_700_000_000_000_000_000 + ms * 1_000_000, 0)
}

#[test]
fn a_master_control_is_told_in_the_words_of_vda_5050() {
    let Some(mut joined) = active("ros-vda", "/r2", &["save_pose_rate: 0.0"], &[]) else {
        return;
    };
    let robot = &mut joined.robot;
    robot.order("fleet", json!({}));
    subscribe(robot, "docking", "localization");
    // Once its call is answered, its subscription has arrived.
    assert_eq!(state(robot), "active");
    let poses = poses_of(&joined.graph);
    let sent = tracked(stamp(0));
    send_pose(&poses, &sent);
    let standard = robot.wait_for("vda5050");
    assert_eq!(standard["key"], "vda5050/0/r2/localization");
    assert_eq!(standard["encoding"], "application/json");
    assert_eq!(standard["position"]["mapId"], "00000000000000ff");
    assert_eq!(standard["position"]["x"], 3.0);
    let verdict = of_scan(robot, "localization", sent.stamp.measured_ns);
    assert_eq!(verdict["state"], 1);
    assert_eq!(verdict["reason"], "one place");
    assert_eq!(verdict["pose"]["pose"]["position"]["x"], 3.0);
    assert_eq!(verdict["pose"]["covariance"][7], 1e-2);
    // A late subscriber gets the last one at once.
    subscribe(robot, "late", "localization");
    of_scan(robot, "localization", sent.stamp.measured_ns);
    let lost = PoseHeader {
        state: TrackState::Lost as u32,
        ..tracked(stamp(100))
    };
    send_pose(&poses, &lost);
    assert_eq!(robot.wait_for("vda5050")["position"]["localized"], false);
    joined.stop();
}

#[test]
fn the_first_map_stays_where_parameters_say_so() {
    let more = ["first_map_only: true", "save_pose_rate: 0.0"];
    let Some(mut joined) = active("ros-first-map", "/", &more, &[]) else {
        return;
    };
    let graph = &joined.graph;
    let robot = &mut joined.robot;
    let maps = graph.subscriber::<topic::Map>().unwrap();
    robot.order("arrive", json!({}));
    let next = || {
        wait_for(graph, &maps, |header: &MapHeader, cells| {
            Some((header.map_id, cells.to_vec()))
        })
    };
    let (_, first) = next();
    // Another map, which is ignored.
    robot.order("other_map", json!({ "cell": 0 }));
    settle(robot, "active");
    let off = json!({ "name": "first_map_only", "value": { "type": 1, "bool_value": false } });
    ask(
        robot,
        "amcl/set_parameters",
        &json!({ "parameters": [off] }),
    );
    robot.order("other_map", json!({ "cell": 1 }));
    let (_, third) = next();
    let differ: Vec<usize> = (0..first.len())
        .filter(|i| first[*i] != third[*i])
        .collect();
    assert_eq!(differ, [1]);
    joined.stop();
}

/// Waits for the next message to the tracker.
fn hint(graph: &Graph, hints: &Subscriber<topic::InitialPoseTopic>) -> InitialPose {
    wait_for(graph, hints, |hint: &InitialPose, _| Some(*hint))
}

#[test]
fn the_saved_pose_is_a_hint_and_what_somebody_says_is_believed_where_that_is_wanted() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR"));
    let saved = folder.join("saved_pose");
    let file = format!("saved_pose_filepath: {}", saved.display());
    // The file in AMCL's format.
    std::fs::write(
        &saved,
        "frame_id: map\nx: 1.25\ny: -2.5\nz: 0.0\nyaw: 0.5\n",
    )
    .unwrap();
    let more = [
        "initialize_at_saved_pose: true",
        "save_pose_rate: 1000.0",
        &*file,
    ];
    let Some(mut joined) = active("ros-saved", "/", &more, &["--believe-initial-pose"]) else {
        return;
    };
    let graph = &joined.graph;
    let robot = &mut joined.robot;
    let hints = graph.subscriber::<topic::InitialPoseTopic>().unwrap();
    let poses = poses_of(graph);
    let searching = |ms| PoseHeader {
        state: TrackState::Searching as u32,
        ..tracked(stamp(ms))
    };
    // No client on the network may name a file.
    let private = folder.join("private");
    std::fs::write(&private, "mine").unwrap();
    let other = json!({ "name": "saved_pose_filepath",
        "value": { "type": 4, "string_value": private.to_str().unwrap() } });
    for service in ["set_parameters", "set_parameters_atomically"] {
        let wanted = json!({ "parameters": [other] });
        let answer = ask(robot, &format!("amcl/{service}"), &wanted);
        let result = answer
            .get("result")
            .unwrap_or_else(|| &answer["results"][0]);
        assert_eq!(result["successful"], false, "{answer}");
        assert_ne!(result["reason"], "", "{answer}");
    }
    let names = json!({ "names": ["saved_pose_filepath"] });
    let described = ask(robot, "amcl/describe_parameters", &names);
    assert_eq!(described["descriptors"][0]["read_only"], true);

    // A tracker without a pose needs the saved one.
    send_pose(&poses, &searching(-100));
    let first = hint(graph, &hints);
    assert_eq!(
        first.kind,
        InitialPoseKind::Hint as u64,
        "a scan must confirm it"
    );
    assert_eq!(first.map_from_base, pose2(1.25, -2.5, 0.5));
    set_initial_pose(robot, 7.0);
    let said = hint(graph, &hints);
    assert_eq!(
        (said.kind, said.map_from_base.x),
        (InitialPoseKind::Believed as u64, 7.0)
    );
    ask(robot, "reinitialize_global_localization", &json!({}));
    assert_eq!(hint(graph, &hints).kind, InitialPoseKind::Anywhere as u64);

    // The pose that the tracker still believes is from before, and is neither sent nor saved.
    subscribe(robot, "rviz", "amcl_pose");
    subscribe(robot, "docking", "localization");
    assert_eq!(state(robot), "active");
    let before = tracked(stamp(0));
    send_pose(&poses, &before);
    of_scan(robot, "localization", before.stamp.measured_ns);
    assert_eq!(state(robot), "active");
    let said = until_now(robot);
    assert!(
        !said.iter().any(|said| said["event"] == "amcl_pose"),
        "{said:?}"
    );
    send_pose(&poses, &searching(100));
    let sure = tracked(stamp(200));
    send_pose(&poses, &sure);
    of_scan(robot, "amcl_pose", sure.stamp.measured_ns);
    settle(robot, "active");
    let text = std::fs::read_to_string(&saved).unwrap();
    assert!(
        text.contains("\nx: 3.0\ny: 1.0\nz: 0.0\nyaw: 0.25\n"),
        "{text}"
    );
    assert!(
        text.starts_with("timestamp: 1700000000.200000000\nframe_id: \"map\"\n"),
        "{text}"
    );
    assert_eq!(std::fs::read_to_string(&private).unwrap(), "mine");
    joined.stop();
}

#[test]
fn a_simulation_that_is_paused_has_no_transform_of_the_future() {
    let more = ["use_sim_time: true", "save_pose_rate: 0.0"];
    let Some(mut joined) = active("ros-sim", "/", &more, &[]) else {
        return;
    };
    let robot = &mut joined.robot;
    robot.order("follow", json!({}));
    let start = stamp(0).measured_ns;
    robot.order("clock", json!({ "ns": start }));
    // Once its call is answered, its subscriptions have arrived.
    assert_eq!(state(robot), "active");
    let poses = poses_of(&joined.graph);
    send_pose(&poses, &tracked(stamp(0)));
    let tolerance_ns = 500_000_000;
    for ms in [0, 60, 130] {
        robot.order("clock", json!({ "ns": start + ms * 1_000_000 }));
        let tf = robot.wait_for("tf");
        let at_ns = tf["stamp"].as_i64().unwrap() - tolerance_ns - start;
        assert_eq!(at_ns, ms * 1_000_000);
        // Time passes here, but not in the simulation.
        for _ in 0..5 {
            assert_eq!(state(robot), "active");
        }
    }
    joined.stop();
}
