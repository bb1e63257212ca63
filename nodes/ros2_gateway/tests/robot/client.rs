//! A client of nav2_amcl: parameters, services, and poses by their scans.

use std::path::PathBuf;

use super::*;

/// Pose of the laser on the recorded robot.
pub(super) const MOUNT: Pose = Pose {
    x: 0.78,
    y: 0.0,
    yaw: 0.0,
};

/// The parameters of `nav2_bringup`, with a tolerance that differs from the default.
const PARAMETERS: &str = "\
amcl:
  ros__parameters:
    alpha1: 0.2
    base_frame_id: base_link
    global_frame_id: map
    laser_max_range: 100.0
    max_particles: 2000
    odom_frame_id: odom
    robot_model_type: nav2_amcl::DifferentialMotionModel
    tf_broadcast: true
    transform_tolerance: 0.5
    scan_topic: scan
";

/// Writes a parameter file of that name, with more parameters, each as `name: value`.
pub(super) fn parameters(name: &str, more: &[&str]) -> PathBuf {
    let file = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(name);
    let more: Vec<String> = more.iter().map(|line| format!("    {line}\n")).collect();
    std::fs::write(&file, format!("{PARAMETERS}{}", more.concat())).unwrap();
    file
}

/// Starts an active node in AMCL's place, with these parameters and options.
pub(super) fn active(
    tag: &str,
    namespace: &str,
    more: &[&str],
    options: &[&str],
) -> Option<Joined> {
    let file = parameters(&format!("{tag}.yaml"), more);
    let common = ["--as", "amcl", "--autostart", "--params-file"];
    let common = [&common, &[file.to_str().unwrap()][..]].concat();
    super::join(tag, namespace, &[&*common, options].concat())
}

/// Calls a service and returns its response.
pub(super) fn ask(robot: &mut Robot, service: &str, request: &Value) -> Value {
    robot.order("ask", json!({ "service": service, "request": request }));
    let said = robot.wait_for("answer");
    assert_eq!(said["service"], service);
    assert_eq!(said["same"], true, "the bytes differ: {said}");
    said["response"].clone()
}

/// Requests the transition of that number; returns its success, and the state after it.
pub(super) fn change(robot: &mut Robot, id: u8) -> (bool, String) {
    let done = ask(
        robot,
        "amcl/change_state",
        &json!({ "transition": { "id": id } }),
    );
    (done["success"].as_bool().unwrap(), state(robot))
}

pub(super) fn state(robot: &mut Robot) -> String {
    let state = ask(robot, "amcl/get_state", &json!({}));
    state["current_state"]["label"].as_str().unwrap().to_owned()
}

/// Makes two calls, after which all messages have come that were sent before.
pub(super) fn settle(robot: &mut Robot, expected: &str) {
    for _ in 0..2 {
        assert_eq!(state(robot), expected);
    }
}

/// Sets the initial pose by a service, at this place on the x axis.
pub(super) fn set_initial_pose(robot: &mut Robot, x: f64) {
    let pose = json!({ "pose": { "header": { "frame_id": "map" }, "pose": { "pose": {
        "position": { "x": x }, "orientation": { "w": 1.0 } } } } });
    ask(robot, "set_initial_pose", &pose);
}

/// Lets the robot drive to a recorded scan; returns the tracker's pose at the scan with this stamp,
/// nanoseconds.
pub(super) fn drive(
    graph: &Graph,
    robot: &mut Robot,
    poses: &Subscriber<topic::Tracked>,
    how: Value,
    stamp: i64,
) -> PoseHeader {
    robot.order("drive", how);
    wait_for(graph, poses, |header: &PoseHeader, _| {
        let is_this = header.from_scan == 1 && header.stamp.measured_ns == stamp;
        is_this.then_some(*header)
    })
}

/// Waits for the transform to the odometry of a scan with this stamp, nanoseconds.
pub(super) fn transform_of(robot: &mut Robot, stamp: i64) -> Value {
    loop {
        let transform = robot.wait_for("tf");
        if transform["stamp"].as_i64().unwrap() >= stamp + 500_000_000 {
            return transform;
        }
    }
}

/// Checks the pose of the laser with the accuracy of all results on this recording.
pub(super) fn assert_true(laser: Pose, truth: Pose) {
    assert!(laser.is_within(truth, 0.2, 0.05), "{laser:?} {truth:?}");
}

/// Returns all events up to now.
pub(super) fn until_now(robot: &mut Robot) -> Vec<Value> {
    robot.order("mark", json!({}));
    let mut all = Vec::new();
    loop {
        let said = robot.receive();
        if said["event"] == "mark" {
            return all;
        }
        all.push(said);
    }
}

/// Starts a subscriber of that name, which also wants the last message.
pub(super) fn subscribe(robot: &mut Robot, name: &str, topic: &str) {
    robot.order("join", json!({ "name": name, "topic": topic }));
}

pub(super) fn planar(value: &Value) -> Pose {
    let of = |index: usize| value[index].as_f64().unwrap();
    Pose::new(of(0), of(1), of(2))
}

/// Returns the message on a topic that belongs to the scan with this stamp, nanoseconds.
pub(super) fn of_scan(robot: &mut Robot, topic: &str, stamp: i64) -> Value {
    loop {
        let said = robot.wait_for(topic);
        let of = match &said["stamp"] {
            Value::Number(number) => number.as_i64(),
            _ => {
                let of = |part: &str| said["header"]["stamp"][part].as_i64();
                of("sec")
                    .zip(of("nanosec"))
                    .map(|(s, ns)| s * 1_000_000_000 + ns)
            }
        };
        assert_eq!(said["same"], true, "the bytes differ: {said}");
        if of == Some(stamp) {
            return said;
        }
    }
}
