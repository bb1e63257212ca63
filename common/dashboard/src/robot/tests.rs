use bytemuck::Zeroable;
use messages::{TrackState, Verdict};
use serde_json::Value;

use super::*;

fn json(text: &str) -> Value {
    serde_json::from_str(text).unwrap()
}

fn receive(robot: &Robot, counter: u64) {
    let mut header = HypothesesHeader {
        verdict: Verdict::Unique as u32,
        ..HypothesesHeader::zeroed()
    };
    header.stamp.counter = counter;
    robot.on_answer(&header, &[Hypothesis::zeroed()], 0);
}

#[test]
fn who_comes_receives_what_is_known_and_then_all_that_follows() {
    let (robot, _requests) = Robot::new("r".into());
    receive(&robot, 1);
    let mut watching = robot.watch(0);
    receive(&robot, 2);
    let snapshot = json(&watching.snapshot);
    assert_eq!(
        (&snapshot["type"], &snapshot["robot"]),
        (&"snapshot".into(), &"r".into())
    );
    assert_eq!(snapshot["answer"]["counter"], 1);
    assert_eq!(
        snapshot["track"][0],
        serde_json::json!([0.0, 0.0, "U", 0.0])
    );
    let news = json(&watching.news.try_recv().unwrap());
    assert_eq!(
        (&news["type"], &news["counter"]),
        (&"answer".into(), &2.into())
    );
    assert!(watching.news.try_recv().is_err());
}

#[test]
fn a_pose_is_reported_beside_the_answer_and_so_is_its_age() {
    let (robot, _requests) = Robot::new("r".into());
    receive(&robot, 1);
    let mut watching = robot.watch(0);
    assert_eq!(json(&watching.snapshot)["pose"], Value::Null, "no tracker");
    let header = PoseHeader {
        sent_ns: 1_000_000_000,
        state: TrackState::Lost as u32,
        ..PoseHeader::zeroed()
    };
    robot.on_pose(&header, b"no place fits", 0);
    let news = json(&watching.news.try_recv().unwrap());
    assert_eq!(
        (&news["type"], &news["state"]),
        (&"pose".into(), &"Lost".into())
    );
    let snapshot = json(&robot.snapshot(3_500_000_000));
    assert_eq!(snapshot["pose"]["says"], "no place fits");
    assert_eq!(snapshot["answer"]["counter"], 1, "the single answer stays");
    assert_eq!(snapshot["graph"], Value::Null, "it is elsewhere");
    assert_eq!(
        snapshot["ages"],
        serde_json::json!({"scan_s": 3.5, "pose_s": 2.5})
    );
}

#[test]
fn who_is_slow_loses_the_oldest_and_receives_how_many() {
    let (robot, _requests) = Robot::new("r".into());
    let mut watching = robot.watch(0);
    for counter in 0..QUEUE as u64 + 3 {
        receive(&robot, counter);
    }
    let lagged = watching.news.try_recv().unwrap_err();
    assert_eq!(
        lagged,
        broadcast::error::TryRecvError::Lagged(4),
        "the state, too"
    );
    assert_eq!(json(&watching.news.try_recv().unwrap())["counter"], 3);
}

#[test]
fn the_field_is_wanted_as_long_as_somebody_looks() {
    let (robot, _requests) = Robot::new("r".into());
    assert!(!robot.is_field_viewed());
    let view = robot.view_field();
    assert!(robot.is_field_viewed());
    drop(view);
    assert!(!robot.is_field_viewed());
}

#[test]
fn requests_are_bounded() {
    let (robot, requests) = Robot::new("r".into());
    assert!((0..MAX_REQUESTS).all(|_| robot.request(Request::Save)));
    assert!(!robot.request(Request::Save));
    assert_eq!(requests.try_iter().count(), MAX_REQUESTS);
}

#[test]
fn the_states_of_the_hour_are_kept_and_each_new_one_is_sent() {
    let (robot, _requests) = Robot::in_graph("r".into(), Some("corridor".into()));
    let mut watching = robot.watch(0);
    let state_of = |text: &str| json(text)["state"].clone();
    let mut pose = PoseHeader {
        sent_ns: 1_000_000_000,
        state: TrackState::Lost as u32,
        from_scan: 1,
        ..PoseHeader::zeroed()
    };
    pose.stamp.entered_ns = 1_000_000_000;
    robot.on_pose(&pose, b"no place fits: is it this map?", 1_000_000_000);
    assert_eq!(state_of(&watching.news.try_recv().unwrap()), "Lost", "pose");
    let news = json(&watching.news.try_recv().unwrap());
    assert_eq!(
        (&news["type"], &news["state"]),
        (&"state".into(), &"Lost".into())
    );
    assert_eq!(news["why"], "no place fits");
    // With a tracker, single scans are no states.
    receive(&robot, 2);
    robot.look_for_silence(4_000_000_000);
    let snapshot = json(&robot.snapshot(5_000_000_000));
    assert_eq!(snapshot["graph"], "corridor");
    let states = snapshot["states"].as_array().unwrap();
    let words: Vec<_> = states.iter().map(|state| &state["state"]).collect();
    assert_eq!(words, ["Lost", "NoData"]);
    assert_eq!(states[0]["ago_s"], 4.0);
}
