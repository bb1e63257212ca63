//! A robot that is carried away, with the gateway in AMCL's place.

use super::client::{
    MOUNT, active, assert_true, drive, of_scan, planar, settle, subscribe, transform_of, until_now,
};
use super::filter::wait_until_all_ready;
use super::*;

/// Number of recorded scans that are left out while it is carried: some metres.
const CARRIED: usize = 8;

#[test]
fn a_robot_that_is_carried_away_has_no_transform_before_it_is_found_again() {
    let Some(mut joined) = active("ros-carried", "/", &["save_pose_rate: 0.0"], &[]) else {
        return;
    };
    let nodes = start_nodes(&joined.graph, &NODES);
    let graph = &joined.graph;
    let poses = graph.subscriber::<topic::Tracked>().unwrap();
    let robot = &mut joined.robot;
    robot.order("follow", json!({}));
    subscribe(robot, "docking", "localization");
    robot.order("arrive", json!({}));
    wait_until_all_ready(graph, &NODES);
    let truths = World::of("malaga_corridor").truths();
    let (odometry, scans) = (recorded(Kind::Odometry), scans());
    let stamp = |index: usize| scans[index].header.stamp.as_ns();
    let odom_from_base = |index: usize| match &odometry[index] {
        Message::Odometry(odometry) => odometry.pose.pose.planar().unwrap(),
        other => panic!("{:?}", other.kind()),
    };
    let drive = |robot: &mut Robot, index: usize, time: usize, odom: Pose| -> PoseHeader {
        let Pose { x, y, yaw } = odom;
        let how = json!({ "index": index, "time": time, "odom": [x, y, yaw] });
        drive(graph, robot, &poses, how, stamp(time))
    };
    // It finds itself, and drives on for a while.
    let (mut sure, mut index) = (0, 0);
    while sure < 3 {
        let pose = drive(robot, index, index, odom_from_base(index));
        sure += usize::from(pose.is_unique());
        index += 1;
    }
    // Then its wheels stand still while it is carried.
    let (left, put) = (index - 1, index - 1 + CARRIED);
    let jump = odom_from_base(left).then(odom_from_base(put).inverse());
    let (mut was_lost, mut found) = (false, 0);
    while found < 2 {
        let from = index - left - 1 + put;
        assert!(
            from < scans.len(),
            "it was not found before the recording ended"
        );
        let odom = jump.then(odom_from_base(from));
        let pose = drive(robot, from, index, odom);
        // Messages after the verdict belong to this scan.
        of_scan(robot, "localization", stamp(index));
        if pose.is_unique() {
            assert!(was_lost, "a place elsewhere is not the same");
            let transform = transform_of(robot, stamp(index));
            let laser = planar(&transform["pose"]).then(odom).then(MOUNT);
            assert_true(laser, truths[&stamp(from)].pose);
            found += 1;
        } else if !pose.is_believed() {
            was_lost = true;
            until_now(robot);
            settle(robot, "active");
            let said = until_now(robot);
            let is_transform = |said: &Value| said["event"] == "tf";
            assert!(!said.iter().any(is_transform), "{said:?}");
        }
        index += 1;
    }
    nodes.into_iter().for_each(NodeProcess::stop);
    joined.stop();
}
