//! A robot of ROS 2 Humble, whose types have no hashes.

use super::client::{active, ask, of_scan, state, subscribe};
use super::tracked::send_pose;
use super::*;

#[test]
fn a_robot_whose_types_have_no_hashes_is_understood_and_understands() {
    let Some(mut joined) = active("ros-humble", "/", &["save_pose_rate: 0.0"], &[]) else {
        return;
    };
    let graph = &joined.graph;
    let robot = &mut joined.robot;
    let maps = graph.subscriber::<topic::Map>().unwrap();
    let scans_in = graph.subscriber::<topic::Scan>().unwrap();
    let odometry_in = graph.subscriber::<topic::OdometryTopic>().unwrap();
    robot.order("know_no_hashes", json!({}));
    robot.order("arrive", json!({}));
    wait_for(graph, &maps, |_: &MapHeader, _| Some(()));
    robot.order("drive", json!({ "index": 0 }));
    let header: ScanHeader = wait_for(graph, &scans_in, |header, _| Some(*header));
    assert_eq!(header.mount_known, 1, "by /tf_static");
    wait_for(graph, &odometry_in, |_: &Odometry, _| Some(()));

    // Services and topics of the node.
    assert_eq!(state(robot), "active");
    let names = json!({ "names": ["scan_topic"] });
    let got = ask(robot, "amcl/get_parameters", &names);
    assert_eq!(got["values"][0]["string_value"], "scan");
    robot.order("follow", json!({}));
    assert_eq!(state(robot), "active");
    let poses = poses_of(graph);
    let sent = tracked(header.stamp);
    send_pose(&poses, &sent);
    of_scan(robot, "amcl_pose", sent.stamp.measured_ns);
    assert_eq!(robot.wait_for("tf")["same"], true);
    // A late subscriber gets the last pose.
    subscribe(robot, "late", "amcl_pose");
    of_scan(robot, "amcl_pose", sent.stamp.measured_ns);
    joined.stop();
}
