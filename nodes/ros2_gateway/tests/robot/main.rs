//! A ROS 2 robot of other people's libraries, and the gateway between it and a graph:
//! every message both ways, and a particle filter that gets initial poses.
#![allow(
    clippy::unwrap_used,
    reason = "the lint spares test functions but not what they share"
)]

mod amcl;
mod carried;
mod clicks;
mod client;
mod filter;
mod humble;
mod nav2;
mod refusals;
#[path = "../shared/mod.rs"]
mod shared;
mod tracked;
mod waiting;

use bytemuck::Zeroable;
use geometry::Pose;
use messages::{
    FrameName, HypothesesHeader, Hypothesis, MapHeader, NodeState, Odometry, PoseHeader,
    ScanHeader, Stamp, TrackState, Verdict, topic,
};
use recording::{Kind, Message, Recording};
use ros::LaserScan;
use serde_json::{Value, json};
use shared::{
    Joined, NODES, pose2, poses_of, start_gateway, start_nodes, tracked, wait_until_waiting,
};
use tests::robot::Robot;
use tests::world::World;
use transport::testing::{
    Isolated, NodeProcess, wait_for, wait_for_health, wait_for_next, wait_until_ready,
};
use transport::{Graph, Publisher, Subscriber};

/// Joins a robot to a gateway that is its router; returns `None` if its libraries are missing.
fn join(tag: &str, namespace: &str, options: &[&str]) -> Option<Joined> {
    let isolated = Isolated::new(tag);
    let endpoint = format!("tcp/{}:7447", isolated.name().loopback());
    let common = ["--domain", "0", "--namespace", namespace, "--listen"];
    let arguments = [&common[..], &[&*endpoint], options].concat();
    Joined::new(isolated, &arguments, |graph| {
        // It has joined as soon as it says what it waits for.
        wait_until_waiting(graph, "waiting for");
        let recording = World::of("malaga_corridor").recording();
        Robot::start(&endpoint, &recording, namespace)
    })
}

/// Waits until the gateway is ready, by reports from when `health` joined.
fn wait_until_green(graph: &Graph, health: &Subscriber<topic::Health>) {
    let ready = NodeState::Ready as u32;
    wait_for_health(graph, health, |report| {
        report.node.as_str() == "ros2_gateway" && report.state == ready
    });
}

/// The recorded messages of a kind.
fn recorded(kind: Kind) -> Vec<Message> {
    let recording = Recording::open(World::of("malaga_corridor").recording()).unwrap();
    let records = recording.records_of(&[kind]);
    records.map(|record| record.unwrap().message).collect()
}

fn scans() -> Vec<LaserScan> {
    World::of("malaga_corridor").scans()
}

/// Compares a pose that other libraries have converted: quaternions give back a yaw to a few units
/// in the last place.
fn assert_near(found: &Value, expected: Pose) {
    let found = client::planar(found);
    assert!(
        found.is_within(expected, 1e-9, 1e-9),
        "{found:?} {expected:?}"
    );
}

#[test]
fn what_the_robot_sends_enters_the_graph_as_it_is() {
    let Some(mut joined) = join("ros-in", "/r2", &[]) else {
        return;
    };
    let graph = &joined.graph;
    let maps = graph.subscriber::<topic::Map>().unwrap();
    let scans_in = graph.subscriber::<topic::Scan>().unwrap();
    let odometry_in = graph.subscriber::<topic::OdometryTopic>().unwrap();
    joined.robot.order("arrive", json!({}));
    // The map is kept for late subscribers, such as the gateway.
    let map: (MapHeader, Vec<u8>) = wait_for_next(graph, &maps);
    let Message::Map(expected) = recorded(Kind::Map).remove(0) else {
        panic!("no map");
    };
    let expected = expected.to_grid().unwrap();
    assert_eq!(map.0.map_id, expected.id());
    assert_eq!(
        (map.0.width, map.0.height),
        (expected.width, expected.height)
    );
    assert_eq!(map.1, expected.cells);
    for (index, expected) in scans().iter().take(5).enumerate() {
        joined.robot.order("scan", json!({ "index": index }));
        let (header, ranges): (ScanHeader, Vec<f32>) = wait_for_next(graph, &scans_in);
        assert_eq!(ranges, expected.ranges);
        assert_eq!(header.stamp.measured_ns, expected.header.stamp.as_ns());
        assert_eq!(header.stamp.counter, index as u64);
        assert_eq!(header.angle_min, f64::from(expected.angle_min));
        assert_eq!(header.range_max_m, expected.range_max);
        // By /tf_static, which came before.
        assert_eq!(header.mount_known, 1);
        assert_eq!(header.base_from_laser, pose2(0.78, 0.0, 0.0));
    }
    let Message::Odometry(expected) = recorded(Kind::Odometry).remove(0) else {
        panic!("no odometry");
    };
    let odometry: Odometry = wait_for(graph, &odometry_in, |odometry, _| Some(*odometry));
    assert_eq!(
        odometry.odom_from_child,
        expected.pose.pose.planar().unwrap().into()
    );
    assert_eq!(odometry.covariance, expected.pose.planar_covariance());
    assert_eq!(
        odometry.child_frame,
        FrameName::new(&expected.child_frame_id)
    );
    joined.stop();
}

#[test]
fn several_lasers_enter_by_their_names_and_mounts() {
    let options = ["--scan", "front/scan", "--scan", "rear/scan"];
    let Some(mut joined) = join("ros-lasers", "/r2", &options) else {
        return;
    };
    let graph = &joined.graph;
    let scans_in = graph.subscriber::<topic::Scan>().unwrap();
    // The rear one looks back and is rolled by half a turn: z by π, then x by π.
    let level = [0.0, 0.0, 0.0, 1.0];
    let over = [0.0, 1.0, 0.0, 0.0];
    let lasers = json!([["front", 0.5, level], ["rear", -0.4, over]]);
    joined.robot.order("mounts", json!({ "lasers": lasers }));
    let expected = [
        ("front", pose2(0.5, 0.0, 0.0), 0),
        ("rear", pose2(-0.4, 0.0, std::f64::consts::PI), 1),
    ];
    let recorded = scans();
    for (index, scan) in recorded.iter().take(3).enumerate() {
        for (laser, mount, upside_down) in expected {
            let order = json!({ "laser": laser, "index": index });
            joined.robot.order("scan_of", order);
            let (header, ranges): (ScanHeader, Vec<f32>) = wait_for_next(graph, &scans_in);
            assert_eq!(header.laser.as_str(), laser);
            assert_eq!(header.frame.as_str(), format!("{laser}_laser"));
            // Each laser counts its own scans.
            assert_eq!(header.stamp.counter, index as u64);
            assert_eq!(ranges, scan.ranges);
            assert_eq!((header.mount_known, header.upside_down), (1, upside_down));
            // Through a quaternion: a yaw of π may come back as one of -π.
            let found = Pose::from(header.base_from_laser);
            assert!(found.is_within(mount.into(), 1e-12, 1e-12), "{found:?}");
        }
    }
    joined.stop();
}

fn hypotheses(counter: u64, verdict: Verdict) -> (HypothesesHeader, Vec<Hypothesis>) {
    let header = HypothesesHeader {
        stamp: transport::stamp_now(1_700_000_000_000_000_000 + counter as i64, counter),
        verdict: verdict as u32,
        mount_known: 1,
        ..HypothesesHeader::zeroed()
    };
    let item = |x: f64| Hypothesis {
        map_from_laser: pose2(x + 0.5, 2.0, 0.0),
        map_from_base: pose2(x, 2.0, 0.0),
        covariance: [4e-4, 0.0, 0.0, 0.0, 1e-2, 0.0, 0.0, 0.0, 1e-6],
        ..Hypothesis::zeroed()
    };
    (header, vec![item(1.0), item(-7.0)])
}

fn send(
    publisher: &Publisher<topic::Hypotheses>,
    (header, items): &(HypothesesHeader, Vec<Hypothesis>),
) {
    publisher.send(*header, items).unwrap();
}

#[test]
fn what_the_graph_says_reaches_the_robot_byte_for_byte() {
    let Some(mut joined) = join("ros-out", "/", &["--broadcast-tf", "--odom-frame", "odom"]) else {
        return;
    };
    let publisher = joined.graph.publisher::<topic::Hypotheses>().unwrap();
    let robot = &mut joined.robot;
    for order in ["arrive", "transforms", "filter", "tokens"] {
        robot.order(order, json!({}));
    }
    let tokens = robot.wait_for("tokens");
    assert_eq!(tokens["same"], true, "{tokens}");
    let expected = [
        "MP /diagnostics ::,10:,:,:,,",
        "MP /hypotheses ::,10:,:,:,,",
        "MP /initialpose ::,1:,:,:,,",
        "MP /tf ::,100:,:,:,,",
        "MS /amcl_pose ::,10:,:,:,,",
        "MS /map :1:,1:,:,:,,",
        "MS /odom 2::,16:,:,:,,",
        "MS /scan 2::,5:,:,:,,",
        "MS /tf ::,100:,:,:,,",
        "MS /tf_static :1:,100:,:,:,,",
        "NN",
        "SS /reinitialize_global_localization ::,10:,:,:,,",
    ];
    assert_eq!(tokens["found"], json!(expected));
    let scans_in = joined.graph.subscriber::<topic::Scan>().unwrap();
    robot.order("scan", json!({ "index": 0 }));
    wait_for(&joined.graph, &scans_in, |_, _| Some(()));
    // The verdict decides whether the filter gets an initial pose.
    for (counter, verdict) in [Verdict::Ambiguous, Verdict::Unique]
        .into_iter()
        .enumerate()
    {
        let sent = hypotheses(counter as u64, verdict);
        send(&publisher, &sent);
        let mut received = std::collections::BTreeMap::new();
        let wanted = if verdict == Verdict::Unique { 3 } else { 1 };
        while received.len() < wanted {
            let said = joined.robot.receive();
            let event = said["event"].as_str().unwrap().to_owned();
            assert_eq!(said["same"], true, "the bytes of {event} differ");
            assert_eq!(said["attachment"], 33);
            if event != "/diagnostics" {
                received.insert(event, said);
            }
        }
        let stamp = sent.0.stamp.measured_ns;
        let poses = &received["hypotheses"];
        assert_eq!(poses["stamp"], stamp);
        assert_eq!(poses["frame"], "map");
        assert_near(&poses["poses"][0], Pose::new(1.0, 2.0, 0.0));
        assert_near(&poses["poses"][1], Pose::new(-7.0, 2.0, 0.0));
        assert_eq!(poses["sequence"], counter + 1);
        let Some(seed) = received.get("initialpose") else {
            assert_eq!(verdict, Verdict::Ambiguous);
            continue;
        };
        assert_eq!(seed["stamp"], stamp);
        assert_near(&seed["pose"], Pose::new(1.0, 2.0, 0.0));
        // At least the spread of 0.1 m and 3 degrees.
        let variances: Vec<f64> = serde_json::from_value(seed["variances"].clone()).unwrap();
        assert_eq!(variances[0], 0.1 * 0.1);
        // The laser's variance, and the effect of its yaw half a metre away, up to rounding.
        assert!((variances[1] - (0.01 + 0.25e-6)).abs() < 1e-12);
        assert!((variances[2].sqrt().to_degrees() - 3.0).abs() < 1e-9);
        let tf = &received["tf"];
        assert_eq!(tf["stamp"], stamp + 1_000_000_000);
        assert_eq!(tf["child"], "odom");
    }
    // The state of a node of the graph; one report a second.
    let report = loop {
        let said = joined.robot.wait_for("/diagnostics");
        assert_eq!(said["same"], true);
        if said["status"][0][0] == "backcast: ros2_gateway" {
            break said;
        }
    };
    assert_eq!(report["status"][0][1], 0);
    assert_eq!(report["status"][0][2], "Ready");
    joined.stop();
}
