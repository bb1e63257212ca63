//! An operator who clicks "2D Pose Estimate", with the gateway in AMCL's place.

use messages::InitialPose;

use super::client::{MOUNT, active, drive, of_scan, planar, subscribe};
use super::filter::wait_until_all_ready;
use super::*;

/// Number of clicks between two scans, as by Simple Commander and an impatient operator.
const CLICKS: usize = 10;

#[test]
fn clicks_leave_a_pose_that_is_right_whether_they_are_right_or_wrong() {
    let Some(mut joined) = active("ros-clicks", "/", &["save_pose_rate: 0.0"], &[]) else {
        return;
    };
    let nodes = start_nodes(&joined.graph, &NODES);
    let graph = &joined.graph;
    let poses = graph.subscriber::<topic::Tracked>().unwrap();
    let hints = graph.subscriber::<topic::InitialPoseTopic>().unwrap();
    let robot = &mut joined.robot;
    subscribe(robot, "rviz", "amcl_pose");
    robot.order("arrive", json!({}));
    wait_until_all_ready(graph, &NODES);
    let truths = World::of("malaga_corridor").truths();
    let scans = scans();
    let stamp = |index: usize| scans[index].header.stamp.as_ns();
    let truth = |index: usize| truths[&stamp(index)].pose.then(MOUNT.inverse());
    let drive = |robot: &mut Robot, index: usize| -> PoseHeader {
        let how = json!({ "index": index });
        drive(graph, robot, &poses, how, stamp(index))
    };
    // The last click has reached the tracker as soon as it has arrived here.
    let click = |robot: &mut Robot, at: Pose| {
        for _ in 0..CLICKS {
            let how = json!({ "frame": "map", "x": at.x, "y": at.y, "yaw": at.yaw });
            robot.order("point", how);
        }
        wait_for(graph, &hints, |hint: &InitialPose, _| {
            (hint.map_from_base.x == at.x).then_some(())
        });
    };
    let mut index = 0;
    while !drive(robot, index).is_unique() {
        index += 1;
    }
    // At least twenty rounds, two in three with a wrong click.
    let rounds = scans.len() - 1 - index;
    assert!(rounds >= 20, "{rounds}");
    for round in 0..rounds {
        let here = truth(index);
        let off = match round % 3 {
            0 => Pose::new(0.3, -0.2, 0.1),
            1 => Pose::new(-12.0, 1.0, 2.0),
            _ => Pose::new(5.0, 4.0, -1.0),
        };
        click(robot, here.then(off));
        index += 1;
        let pose = drive(robot, index);
        assert!(pose.is_believed(), "{round}: {pose:?}");
        let base = planar(&of_scan(robot, "amcl_pose", stamp(index))["pose"]);
        let expected = truth(index);
        assert!(
            base.is_within(expected, 0.25, 0.05),
            "{round}: {base:?} {expected:?}"
        );
    }
    nodes.into_iter().for_each(NodeProcess::stop);
    joined.stop();
}
