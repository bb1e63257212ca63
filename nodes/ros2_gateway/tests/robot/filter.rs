//! A particle filter that gets initial poses.

use super::client::{MOUNT, assert_true, planar};
use super::*;

pub(super) fn wait_until_all_ready(graph: &Graph, nodes: &[&str]) {
    nodes.iter().for_each(|node| wait_until_ready(graph, node));
}

#[test]
fn a_particle_filter_gets_its_initial_pose() {
    let Some(mut joined) = join("ros-amcl", "/", &["--lost-beyond", "1,30"]) else {
        return;
    };
    let engine = &NODES[..3];
    let nodes = start_nodes(&joined.graph, engine);
    let robot = &mut joined.robot;
    robot.order("arrive", json!({}));
    wait_until_all_ready(&joined.graph, engine);
    let truths = World::of("malaga_corridor").truths();
    let stamps: Vec<i64> = scans()
        .iter()
        .map(|scan| scan.header.stamp.as_ns())
        .collect();
    // Returns the initial poses that were sent before the hypotheses of scan `index`.
    let until_answered = |robot: &mut Robot, index: usize| {
        let mut seed = Vec::new();
        loop {
            let said = robot.receive();
            match said["event"].as_str().unwrap() {
                "initialpose" => seed.push(said),
                "hypotheses" if said["stamp"] == stamps[index] => return seed,
                _ => {}
            }
        }
    };
    let scan = |robot: &mut Robot, index: usize| {
        robot.order("scan", json!({ "index": index }));
        until_answered(robot, index)
    };
    // There is no filter yet.
    assert_eq!(scan(robot, 0).len(), 0);
    robot.order("filter", json!({}));
    // It gets one initial pose, by a scan after it started.
    let mut seed = Vec::new();
    let mut index = 0;
    while seed.is_empty() {
        index += 1;
        seed = scan(robot, index);
    }
    assert_eq!(seed.len(), 1);
    assert_eq!(seed[0]["stamp"], stamps[index]);
    assert_eq!(seed[0]["frame"], "map");
    let base = planar(&seed[0]["pose"]);
    assert_true(base.then(MOUNT), truths[&stamps[index]].pose);
    let believe = |robot: &mut Robot, index: usize, x: f64| {
        let (y, yaw) = (base.y, base.yaw);
        robot.order(
            "believe",
            json!({ "index": index, "x": x, "y": y, "yaw": yaw }),
        );
    };
    // The filter follows the robot, and gets no further pose.
    let before = refused_by_gateway(&joined.graph);
    for _ in 0..3 {
        index += 1;
        believe(robot, index, base.x);
        assert_eq!(scan(robot, index).len(), 0);
    }
    // A client requests an initial pose.
    robot.order("call", json!({}));
    let called = robot.wait_for("called");
    assert_eq!(called["reply"], "0001000000", "{called}");
    assert_eq!(called["sequence"], 7);
    assert_eq!(called["sender"], "0123456789abcdef");
    index += 1;
    assert_eq!(scan(robot, index).len(), 1);
    // The robot is carried away.
    let mut seed = Vec::new();
    while seed.is_empty() {
        index += 1;
        believe(robot, index, base.x + 5.0);
        seed = scan(robot, index);
    }
    assert_eq!(seed.len(), 1);
    assert_eq!(
        refused_by_gateway(&joined.graph),
        before,
        "something was refused"
    );
    nodes.into_iter().for_each(NodeProcess::stop);
    joined.stop();
}

/// Returns the number of messages that the gateway has rejected.
fn refused_by_gateway(graph: &Graph) -> u64 {
    let health = graph.subscriber::<topic::Health>().unwrap();
    let is_gateway = |report: &messages::HealthHeader| report.node.as_str() == "ros2_gateway";
    wait_for_health(graph, &health, is_gateway).0.refused
}
