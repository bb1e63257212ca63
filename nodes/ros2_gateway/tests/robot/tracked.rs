//! A graph with a tracker.

use super::client::subscribe;
use super::*;

pub(super) fn send_pose(publisher: &Publisher<topic::Tracked>, header: &PoseHeader) {
    let words = b"one place";
    publisher.send(*header, words).unwrap();
}

#[test]
fn a_robot_whose_pose_is_tracked_is_sent_that_pose_and_no_single_answer() {
    let options = ["--broadcast-tf", "--odom-frame", "odom"];
    let Some(mut joined) = join("ros-pose", "/", &options) else {
        return;
    };
    let answers = joined.graph.publisher::<topic::Hypotheses>().unwrap();
    let poses = poses_of(&joined.graph);
    for order in ["arrive", "transforms", "filter"] {
        joined.robot.order(order, json!({}));
    }
    let scans_in = joined.graph.subscriber::<topic::Scan>().unwrap();
    joined.robot.order("scan", json!({ "index": 0 }));
    wait_for(&joined.graph, &scans_in, |_, _| Some(()));

    let (answer, items) = hypotheses(0, Verdict::Unique);
    send_pose(&poses, &tracked(answer.stamp));
    let seed = joined.robot.wait_for("initialpose");
    assert_eq!(seed["same"], true, "the bytes differ");
    assert_near(&seed["pose"], Pose::new(3.0, 1.0, 0.25));
    let tf = joined.robot.wait_for("tf");
    assert_eq!(tf["child"], "odom");
    // Another node publishes the same transform.
    let health = joined.graph.subscriber::<topic::Health>().unwrap();
    joined.robot.order("correct", json!({}));
    let named = "from map to odom on /tf, as this one does";
    wait_for(&joined.graph, &health, |_, error| {
        String::from_utf8_lossy(error).contains(named).then_some(())
    });
    // The verdict is a topic as soon as there is a tracker.
    subscribe(&mut joined.robot, "fleet", "localization");
    let said = joined.robot.wait_for("localization");
    assert_eq!((&said["same"], &said["state"]), (&json!(true), &json!(1)));
    assert_eq!(said["reason"], "one place");

    // The hypotheses are elsewhere: they are shown, and not sent as an initial pose.
    let mut header = answer;
    header.stamp.counter += 1;
    header.stamp.measured_ns += 1;
    send(&answers, &(header, items));
    loop {
        let said = joined.robot.receive();
        assert_ne!(said["event"], "initialpose", "{said}");
        if said["event"] == "hypotheses" {
            break;
        }
    }
    joined.stop();
}
