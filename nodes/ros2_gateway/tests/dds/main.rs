//! A ROS 2 robot on DDS, by ROS's own rclpy and Fast DDS, and the gateway between it and a
//! graph.
#![allow(
    clippy::unwrap_used,
    reason = "the lint spares test functions but not what they share"
)]

mod cyclone;
mod drives;
#[path = "../shared/mod.rs"]
mod shared;

use std::fs::File;
use std::process::Command;
use std::sync::Mutex;

use bytemuck::Zeroable;
use messages::{
    HypothesesHeader, Hypothesis, MapHeader, Odometry, PoseHeader, ScanHeader, Stamp, Verdict,
    topic,
};
use serde_json::json;
use shared::{Joined, NODES, pose2, poses_of, start_gateway, start_nodes, wait_until_waiting};
use tests::needs::Need;
use tests::robot::Robot;
use tests::{executables, python};
use transport::testing::{Isolated, NodeProcess, wait_for, wait_for_next};
use transport::{Graph, monotonic_ns, stamp_now};

const LIBRARIES: [&str; 10] = [
    "ros-jazzy-rclpy",
    "ros-jazzy-rmw-fastrtps-cpp",
    "ros-jazzy-sensor-msgs",
    "ros-jazzy-nav-msgs",
    "ros-jazzy-geometry-msgs",
    "ros-jazzy-std-srvs",
    "ros-jazzy-diagnostic-msgs",
    "ros-jazzy-lifecycle-msgs",
    "ros-jazzy-rcl-interfaces",
    "rosbags==0.11.9",
];

/// Mount of the laser.
const MOUNT: [&str; 2] = ["--mount", "0.78,0,0"];

/// Number of beams of a scan.
const BEAMS: usize = 720;

/// Returns a domain that no other test uses, of this process or of another, away from those that
/// people use. A lock on a file holds it until this process ends.
fn domain() -> String {
    static CLAIMED: Mutex<Vec<File>> = Mutex::new(Vec::new());
    let folder = std::env::temp_dir().join("backcast-test-domains");
    std::fs::create_dir_all(&folder).unwrap();
    let claim = |domain: u32| {
        let file = File::create(folder.join(domain.to_string())).unwrap();
        file.try_lock().ok().map(|()| (domain, file))
    };
    // The ports of DDS end at domain 232.
    let (domain, file) = (101..=232)
        .find_map(claim)
        .expect("a domain that no test uses");
    CLAIMED.lock().unwrap().push(file);
    domain.to_string()
}

/// Joins a robot to a gateway in a domain of their own; returns `None` if ROS is not available.
fn join(tag: &str, namespace: &str, options: &[&str]) -> Option<Joined> {
    join_in(&domain(), tag, namespace, options)
}

fn join_in(domain: &str, tag: &str, namespace: &str, options: &[&str]) -> Option<Joined> {
    let common = ["--rmw", "dds", "--domain", domain, "--namespace", namespace];
    let arguments = [&common, options].concat();
    Joined::new(Isolated::new(tag), &arguments, |_| robot(domain, namespace))
}

fn restart_gateway(joined: &mut Joined) {
    joined.stop();
    joined.gateway = Some(start_gateway(&joined.graph, &joined.arguments));
}

fn robot(domain: &str, namespace: &str) -> Option<Robot> {
    let python = python::with(
        "ros",
        &LIBRARIES,
        "rclpy, nav_msgs, lifecycle_msgs, rosbags",
    )
    .map_err(|why| Need::Python.is_missing("a robot with ROS 2 on DDS", &why))
    .ok()?;
    let mut command = Command::new(python);
    command
        .args([
            "-c",
            include_str!("robot.py"),
            namespace,
            &BEAMS.to_string(),
        ])
        .env("ROS_DOMAIN_ID", domain)
        .env("ROS_AUTOMATIC_DISCOVERY_RANGE", "SUBNET")
        .env("RMW_IMPLEMENTATION", "rmw_fastrtps_cpp");
    Some(Robot::run(&mut command))
}

/// Lets the robot drive until a scan and an odometry message are in the graph, once both sides have
/// discovered each other.
fn drive(joined: &mut Joined, ns: i64) -> (ScanHeader, Vec<f32>, Odometry) {
    let Joined { graph, robot, .. } = joined;
    until_both(graph, |since| {
        robot.order("drive", json!({ "ns": ns + since }));
    })
}

/// Calls `drive` with times that increase, until there is a scan whose mount is known, and an
/// odometry message.
fn until_both(graph: &Graph, mut drive: impl FnMut(i64)) -> (ScanHeader, Vec<f32>, Odometry) {
    let scans = graph.subscriber::<topic::Scan>().unwrap();
    let odometries = graph.subscriber::<topic::OdometryTopic>().unwrap();
    let (mut scan, mut odometry, mut since) = (None, None, 0);
    let tick = std::time::Duration::from_millis(100);
    let run = graph.run(&[&scans, &odometries], tick, |wake| {
        if wake.tick {
            drive(since);
            since += 1_000_000;
        }
        while let Some(sample) = scans.receive()? {
            if sample.header().mount_known == 1 {
                scan.get_or_insert((*sample.header(), sample.items().to_vec()));
            }
        }
        while let Some(sample) = odometries.receive()? {
            odometry.get_or_insert(*sample.header());
        }
        Ok::<_, transport::TransportError>(match scan.is_some() && odometry.is_some() {
            true => transport::Flow::Stop,
            false => transport::Flow::Continue,
        })
    });
    run.unwrap();
    let (header, ranges) = scan.unwrap();
    (header, ranges, odometry.unwrap())
}

/// Stamp of the first scan, nanoseconds.
const START_NS: i64 = 1_700_000_000_000_000_000;

fn stamp(counter: u64) -> Stamp {
    stamp_now(START_NS, counter)
}

/// Returns the pose of a tracker that is sure of it.
fn tracked() -> PoseHeader {
    PoseHeader {
        map_from_base: pose2(3.0, 1.0, 0.0),
        ..shared::tracked(stamp(0))
    }
}

#[test]
fn scan_odometry_and_a_large_map_enter_the_graph() {
    let Some(mut joined) = join("dds-in", "/r2", &MOUNT) else {
        return;
    };
    wait_until_waiting(&joined.graph, "/r2/scan: no publisher");
    let (header, ranges, odometry) = drive(&mut joined, START_NS);
    assert_eq!(ranges.len(), BEAMS);
    assert_eq!(ranges[..2], [1.0, 1.01]);
    assert!(header.stamp.measured_ns >= START_NS);
    assert_eq!(header.frame.as_str(), "laser");
    assert_eq!(header.base_from_laser, pose2(0.78, 0.0, 0.0));
    assert_eq!(odometry.odom_from_child, pose2(1.5, 0.0, 0.0));

    // 16 MB, in some hundred fragments.
    let maps = joined.graph.subscriber::<topic::Map>().unwrap();
    let size = json!({ "width": 4000, "height": 4000 });
    joined.robot.order("map", size);
    let (header, cells): (MapHeader, Vec<u8>) = wait_for_next(&joined.graph, &maps);
    assert_eq!((header.width, header.height), (4000, 4000));
    let occupied = cells.iter().filter(|cell| **cell == cells[0]);
    assert_eq!(occupied.count(), 4000);

    // A gateway that starts again gets the map without being sent it again.
    restart_gateway(&mut joined);
    let (again, _): (MapHeader, Vec<u8>) = wait_for_next(&joined.graph, &maps);
    assert_eq!(again.map_id, header.map_id);
    drive(&mut joined, START_NS);
    joined.stop();
}

#[test]
fn what_the_graph_says_reaches_the_robot() {
    let Some(mut joined) = join("dds-out", "/", &MOUNT) else {
        return;
    };
    drive(&mut joined, START_NS);
    let (graph, robot) = (&joined.graph, &mut joined.robot);
    let publisher = graph.publisher::<topic::Hypotheses>().unwrap();
    for topic in ["hypotheses", "initialpose", "/diagnostics"] {
        robot.order("subscribe", json!({ "topic": topic }));
    }
    let diagnostics = robot.wait_for("/diagnostics");
    assert_eq!(diagnostics["names"], json!(["backcast: ros2_gateway"]));
    // The filter has come by now, or comes.
    let item = Hypothesis {
        map_from_base: pose2(1.0, 2.0, 0.0),
        map_from_laser: pose2(1.2, 2.0, 0.0),
        ..Hypothesis::zeroed()
    };
    let send = |counter| {
        let header = HypothesesHeader {
            stamp: stamp(counter),
            verdict: Verdict::Unique as u32,
            mount_known: 1,
            ..HypothesesHeader::zeroed()
        };
        publisher.send(header, &[item]).unwrap();
        robot.receive()
    };
    let seed = (0..).map(send).find(|said| said["event"] == "initialpose");
    let seed = seed.unwrap();
    assert_eq!(seed["poses"], json!([[1.0, 2.0, 0.0, 1.0]]));
    assert_eq!(seed["stamp"], START_NS);
    assert_eq!(seed["frame"], "map");
    let hypotheses = robot.wait_for("hypotheses");
    assert_eq!(hypotheses["poses"][0], seed["poses"][0]);

    // Every client that asks gets a response.
    robot.order("reinitialize", json!({ "clients": 20 }));
    let said = robot.wait_for("reinitialized");
    assert_eq!(said["missing"], 0);

    // The graph of ROS shows the node and its topics.
    robot.order("nodes", json!({ "topic": "hypotheses" }));
    let said = robot.wait_for("nodes");
    let nodes: Vec<String> = serde_json::from_value(said["nodes"].clone()).unwrap();
    assert!(nodes.contains(&"/backcast".to_owned()), "{nodes:?}");
    assert_eq!(said["publishers"], json!(["backcast"]));
    joined.stop();
}

#[test]
fn a_lifecycle_manager_configures_and_activates_us_in_amcls_place() {
    let Some(mut joined) = join("dds-amcl", "/", &["--as", "amcl"]) else {
        return;
    };
    let (graph, robot) = (&joined.graph, &mut joined.robot);
    let mut change = |id: u8| {
        robot.order("change", json!({ "id": id }));
        let success = robot.wait_for("change")["success"].as_bool().unwrap();
        robot.order("state", json!({}));
        (success, robot.wait_for("state")["label"].clone())
    };
    assert_eq!(change(3), (false, json!("unconfigured")));
    assert_eq!(change(1), (true, json!("inactive")));
    assert_eq!(change(3), (true, json!("active")));

    let set = json!({ "name": "save_pose_rate", "value": 0.25 });
    robot.order("parameters", set);
    let said = robot.wait_for("parameters");
    let listed: Vec<String> = serde_json::from_value(said["listed"].clone()).unwrap();
    assert!(listed.contains(&"laser_max_range".to_owned()), "{listed:?}");
    assert_eq!(said["successful"], true);
    assert_eq!(said["value"], 0.25);

    // A click goes to the tracker, and the tracker's pose to the robot.
    let hints = graph.subscriber::<topic::InitialPoseTopic>().unwrap();
    robot.order("click", json!({ "ns": START_NS, "x": 3.0, "y": 1.0 }));
    let hint = wait_for(graph, &hints, |hint, _| Some(hint.map_from_base));
    assert_eq!(hint, pose2(3.0, 1.0, 0.0));
    let poses = poses_of(graph);
    poses.send(tracked(), &[]).unwrap();
    // Kept for late subscribers.
    robot.order("subscribe", json!({ "topic": "amcl_pose" }));
    let pose = robot.wait_for("amcl_pose");
    assert_eq!(pose["poses"], json!([[3.0, 1.0, 0.0, 1.0]]));
    joined.stop();
}

#[test]
fn publishers_that_cannot_be_received_are_named() {
    let Some(mut joined) = join("dds-strange", "/", &MOUNT) else {
        return;
    };
    let graph = &joined.graph;
    joined.robot.order("wrong_type", json!({ "topic": "scan" }));
    let volatile = json!({ "width": 10, "height": 10, "kept": false });
    joined.robot.order("map", volatile);
    wait_until_waiting(graph, "/scan: a publisher of another type");
    wait_until_waiting(graph, "/map: a publisher with another quality of service");
    joined.stop();
}

/// Runs the commands that a user types next to an unknown robot that drives.
#[test]
fn a_robot_is_found_and_checked_while_it_drives() {
    let domain = domain();
    let Some(mut robot) = robot(&domain, "/r2") else {
        return;
    };
    robot.order("play", json!({ "rate": 10, "seconds": 300 }));
    let folder = tempfile::tempdir().unwrap();
    let backcast = |arguments: &[&str]| {
        let mut command = Command::new(executables::path("backcast"));
        command.args(arguments).current_dir(folder.path());
        command.env("ROS_DOMAIN_ID", &domain).output().unwrap()
    };
    let output = backcast(&["init", "--ros2", "--out", "graph.yaml"]);
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{said}");
    let seen = format!("on dds, domain {domain}, /r2/robot publishes /r2/odom, /r2/scan");
    assert!(said.contains(&seen), "{said}");
    let written = std::fs::read_to_string(folder.path().join("graph.yaml")).unwrap();
    let options = format!("--rmw dds --domain {domain} --scan /r2/scan --odom /r2/odom");
    assert!(written.contains(&options), "{written}");

    let output = backcast(&["doctor", "--ros2", "5"]);
    let found = String::from_utf8_lossy(&output.stdout);
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{found}{said}");
    assert!(found.starts_with("the robot:\n"), "{found}{said}");
    let mount = "/tf_static does not say where \"laser\" sits on the robot";
    assert!(found.contains(mount), "{found}{said}");
}

#[test]
fn nothing_crosses_to_another_domain_or_namespace() {
    let (own, next) = (domain(), domain());
    let Some(mut joined) = join_in(&own, "dds-own", "/", &MOUNT) else {
        return;
    };
    let others = [("dds-other", &next, "/"), ("dds-second", &own, "/r2")];
    let others = others.map(|(tag, domain, namespace)| {
        let isolated = Isolated::new(tag);
        let graph = isolated.join("test");
        let options = ["--rmw", "dds", "--domain", domain, "--namespace", namespace];
        let options = [&options, &MOUNT[..]].concat();
        let options: Vec<String> = options.into_iter().map(str::to_owned).collect();
        let gateway = start_gateway(&graph, &options);
        let scans = graph.subscriber::<topic::Scan>().unwrap();
        (isolated, graph, scans, gateway, namespace)
    });
    // Repeated while that robot's own gateway is restarted.
    for _ in 0..3 {
        drive(&mut joined, START_NS);
        restart_gateway(&mut joined);
    }
    for (_isolated, graph, scans, gateway, namespace) in others {
        let topic = format!("{}/scan", namespace.trim_end_matches('/'));
        wait_until_waiting(&graph, &format!("{topic}: no publisher"));
        assert!(scans.receive().unwrap().is_none(), "{namespace}");
        gateway.stop();
    }
    joined.stop();
}
