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
fn who_is_slow_loses_the_oldest_and_receives_how_many() {
    let (robot, _requests) = Robot::new("r".into(), None);
    let mut watching = robot.watch(0);
    for counter in 0..QUEUE as u64 + 3 {
        receive(&robot, counter);
    }
    let lagged = watching.news.try_recv().unwrap_err();
    let expected = broadcast::error::TryRecvError::Lagged(4);
    assert_eq!(lagged, expected, "the state, too");
    assert_eq!(json(&watching.news.try_recv().unwrap())["counter"], 3);
}

#[test]
fn requests_are_bounded() {
    let (robot, requests) = Robot::new("r".into(), None);
    assert!((0..MAX_REQUESTS).all(|_| robot.request(Request::Save)));
    assert!(!robot.request(Request::Save));
    assert_eq!(requests.try_iter().count(), MAX_REQUESTS);
}

#[test]
fn the_states_of_the_hour_are_kept_and_each_new_one_is_sent() {
    let (robot, _requests) = Robot::new("r".into(), Some("corridor".into()));
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
    let expected = (&"state".into(), &"Lost".into());
    assert_eq!((&news["type"], &news["state"]), expected);
    assert_eq!(news["why"], "no place fits");
    // With a tracker, single scans are no states.
    receive(&robot, 2);
    robot.look_for_silence(4_000_000_000);
    let snapshot = json(&robot.snapshot(5_000_000_000));
    assert_eq!(snapshot["answer"]["counter"], 2, "with the pose");
    assert_eq!(snapshot["ages"]["pose_s"], 4.0);
    assert_eq!(snapshot["graph"], "corridor");
    let states = snapshot["states"].as_array().unwrap();
    let words: Vec<_> = states.iter().map(|state| &state["state"]).collect();
    assert_eq!(words, ["Lost", "NoData"]);
    assert_eq!(states[0]["ago_s"], 4.0);
}
