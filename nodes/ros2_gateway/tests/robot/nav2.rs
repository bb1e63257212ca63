//! A robot that starts the gateway in the place of nav2_amcl.

use messages::{InitialPose, InitialPoseKind};

use super::client::{
    MOUNT, active, ask, assert_true, change, drive, of_scan, parameters, planar, set_initial_pose,
    settle, state, subscribe, transform_of, until_now,
};
use super::filter::wait_until_all_ready;
use super::*;

#[test]
fn nav2_starts_us_in_amcls_place_and_gets_a_pose_with_no_click() {
    let file = parameters("nav2.yaml", &["save_pose_rate: 0.0"]);
    let options = ["--as", "amcl", "--params-file", file.to_str().unwrap()];
    let Some(mut joined) = join("ros-nav2", "/", &options) else {
        return;
    };
    let nodes = start_nodes(&joined.graph, &NODES);
    let graph = &joined.graph;
    let poses = graph.subscriber::<topic::Tracked>().unwrap();
    let hints = graph.subscriber::<topic::InitialPoseTopic>().unwrap();
    let health = graph.subscriber::<topic::Health>().unwrap();
    let robot = &mut joined.robot;
    robot.order("follow", json!({}));

    // The steps of a lifecycle manager, which the page shows as well.
    assert_eq!(state(robot), "unconfigured");
    wait_until_waiting(
        graph,
        "waiting for a lifecycle manager: the node is unconfigured",
    );
    assert_eq!(change(robot, 3), (false, "unconfigured".into()));
    assert_eq!(change(robot, 1), (true, "inactive".into()));
    let event = robot.wait_for("amcl/transition_event");
    assert_eq!(event["goal_state"]["label"], "configuring");
    robot.order("arrive", json!({}));
    wait_until_all_ready(graph, &NODES);
    assert_eq!(change(robot, 3), (true, "active".into()));
    let bond = robot.wait_for("bond");
    assert_eq!(bond["id"], "amcl");
    assert_eq!(bond["active"], true);
    assert_eq!(bond["same"], true);
    subscribe(robot, "docking", "localization");
    robot.order("fleet", json!({}));

    // It drives, and gets a pose.
    let truths = World::of("malaga_corridor").truths();
    let odometry = recorded(Kind::Odometry);
    let scans = scans();
    let drive = |robot: &mut Robot, index: usize| -> bool {
        let (how, stamp) = (json!({ "index": index }), scans[index].header.stamp.as_ns());
        drive(graph, robot, &poses, how, stamp).is_believed()
    };
    let (mut right, mut index) = (0, 0);
    let reports = graph.subscriber::<topic::Health>().unwrap();
    while right < 5 {
        let is_believed = drive(robot, index);
        if index == 0 {
            // The gateway is ready, now that all inputs arrive.
            wait_until_green(graph, &reports);
        }
        let stamp = scans[index].header.stamp.as_ns();
        if is_believed {
            let pose = robot.wait_for("amcl_pose");
            assert_eq!(pose["stamp"], stamp);
            assert_eq!(pose["frame"], "map");
            assert_eq!(pose["same"], true);
            let truth = truths[&stamp].pose;
            assert_true(planar(&pose["pose"]).then(MOUNT), truth);
            // The transforms give the same pose.
            let tf = transform_of(robot, stamp);
            let Message::Odometry(odometry) = &odometry[index] else {
                panic!("no odometry");
            };
            let odom_from_base = odometry.pose.pose.planar().unwrap();
            assert_true(planar(&tf["pose"]).then(odom_from_base).then(MOUNT), truth);
            // So do the verdict and the position for a master control.
            let verdict = of_scan(robot, "localization", stamp);
            assert!(
                [1, 2].contains(&verdict["state"].as_i64().unwrap()),
                "{verdict}"
            );
            assert_eq!(verdict["pose_known"], true);
            let place = &verdict["pose"]["pose"]["position"];
            assert_eq!(
                (&place["x"], &place["y"]),
                (&pose["pose"][0], &pose["pose"][1])
            );
            let standard = robot.wait_for("vda5050");
            assert_eq!(standard["key"], "vda5050/0/localization");
            right += 1;
        } else {
            let verdict = of_scan(robot, "localization", stamp);
            assert!(
                [0, 3].contains(&verdict["state"].as_i64().unwrap()),
                "{verdict}"
            );
            let standard = robot.wait_for("vda5050");
            assert_eq!(standard["position"]["localized"], false, "{standard}");
        }
        index += 1;
    }
    // Clouds were sent while it searched, and since.
    let cloud = robot.wait_for("particle_cloud");
    assert_eq!(cloud["same"], true);
    let weight = cloud["weight"].as_f64().unwrap();
    assert!(weight > 0.0 && weight <= 1.0 + 1e-9, "{weight}");
    assert!(!cloud["poses"].as_array().unwrap().is_empty());
    until_now(robot);

    // A late subscriber gets the last pose at once.
    subscribe(robot, "late", "amcl_pose");
    let last = robot.wait_for("amcl_pose");
    assert_eq!(last["stamp"], scans[index - 1].header.stamp.as_ns());

    // A clicked pose is a hint, and must be in the map's frame.
    let refused = |least: u64| {
        wait_for_health(graph, &health, |report| {
            report.node.as_str() == "ros2_gateway" && report.refused >= least
        })
    };
    let before = refused(0).0.refused;
    robot.order("point", json!({ "frame": "odom", "x": 1.0, "y": 2.0 }));
    let (_, error) = refused(before + 1);
    assert!(
        error.contains("frame \"odom\": allowed is \"map\""),
        "{error}"
    );
    let hint = |x: f64| {
        wait_for(graph, &hints, |hint: &InitialPose, _| {
            (hint.map_from_base.x == x).then_some(*hint)
        })
    };
    robot.order("point", json!({ "frame": "map", "x": 1.0, "y": 2.0 }));
    assert_eq!(hint(1.0).map_from_base.y, 2.0);
    set_initial_pose(robot, 7.0);
    hint(7.0);
    ask(robot, "request_nomotion_update", &json!({}));

    // It starts over: the pose is forgotten, and found again.
    ask(robot, "reinitialize_global_localization", &json!({}));
    let anywhere = InitialPoseKind::Anywhere as u64;
    wait_for(graph, &hints, |hint, _| {
        (hint.kind == anywhere).then_some(())
    });
    settle(robot, "active");
    until_now(robot);
    let searched = scans[index].header.stamp.as_ns();
    assert!(!drive(robot, index), "the pose is forgotten");
    let verdict = of_scan(robot, "localization", searched);
    assert_eq!(
        (&verdict["state"], &verdict["since"]),
        (&json!(0), &verdict["header"]["stamp"])
    );
    let events = until_now(robot);
    let is_pose = |said: &&Value| said["event"] == "tf" || said["event"] == "amcl_pose";
    assert!(!events.iter().any(|said| is_pose(&said)), "{events:?}");
    index += 1;
    while !drive(robot, index) {
        index += 1;
    }
    let stamp = scans[index].header.stamp.as_ns();
    let base = planar(&of_scan(robot, "amcl_pose", stamp)["pose"]);
    assert_true(base.then(MOUNT), truths[&stamp].pose);
    index += 1;

    // Nothing is published while it is not active.
    assert_eq!(change(robot, 4), (true, "inactive".into()));
    let ended = until_now(robot);
    let last_bond = ended.iter().rfind(|said| said["event"] == "bond");
    assert_eq!(last_bond.unwrap()["active"], false);
    drive(robot, index);
    settle(robot, "inactive");
    let quiet = until_now(robot);
    let events: Vec<&Value> = quiet.iter().map(|said| &said["event"]).collect();
    let is_quiet = |event: &&Value| **event == "/diagnostics";
    assert!(events.iter().all(is_quiet), "{events:?}");
    assert_eq!(change(robot, 2), (true, "unconfigured".into()));
    assert_eq!(change(robot, 5), (true, "finalized".into()));
    nodes.into_iter().for_each(NodeProcess::stop);
    joined.stop();
}

#[test]
fn tools_find_amcl_with_its_names_types_and_parameters() {
    let Some(mut joined) = active("ros-tools", "/", &["save_pose_rate: 0.0"], &[]) else {
        return;
    };
    let robot = &mut joined.robot;
    assert_eq!(state(robot), "active");
    robot.order("endpoints", json!({ "node": "amcl" }));
    let endpoints = robot.wait_for("endpoints");
    assert_eq!(endpoints["wrong"], json!([]));
    let services = [
        "amcl/change_state",
        "amcl/describe_parameters",
        "amcl/get_available_states",
        "amcl/get_available_transitions",
        "amcl/get_parameter_types",
        "amcl/get_parameters",
        "amcl/get_state",
        "amcl/get_transition_graph",
        "amcl/get_type_description",
        "amcl/list_parameters",
        "amcl/set_parameters",
        "amcl/set_parameters_atomically",
        "reinitialize_global_localization",
        "request_nomotion_update",
        "set_initial_pose",
    ];
    let topics = [
        "MP /amcl/transition_event ::,10:,:,:,,",
        "MP /amcl_pose :1:,1:,:,:,,",
        "MP /bond ::,10:,:,:,,",
        "MP /diagnostics ::,10:,:,:,,",
        "MP /localization :1:,1:,:,:,,",
        "MP /parameter_events ::,1000:,:,:,,",
        "MP /particle_cloud 2::,5:,:,:,,",
        "MP /rosout :1:,1000:,:,:,,",
        "MP /tf ::,100:,:,:,,",
        "MS /initialpose ::,10:,:,:,,",
        "MS /map :1:,1:,:,:,,",
        "MS /scan 2::,5:,:,:,,",
        "MS /tf ::,100:,:,:,,",
        "MS /tf_static :1:,100:,:,:,,",
    ];
    let services = services
        .iter()
        .map(|name| format!("SS /{name} ::,10:,:,:,,"));
    let expected: Vec<String> = topics
        .iter()
        .map(|topic| (*topic).to_owned())
        .chain(services)
        .collect();
    assert_eq!(endpoints["found"], json!(expected));

    let wanted = json!({ "type_name": "std_msgs/msg/String" });
    let described = ask(robot, "amcl/get_type_description", &wanted);
    assert_eq!(described["successful"], false);
    let reason = described["failure_reason"].as_str().unwrap();
    assert!(reason.contains("std_msgs/msg/String"), "{reason}");

    // A late subscriber gets the log of the start.
    subscribe(robot, "console", "/rosout");
    let line = robot.wait_for("/rosout");
    assert_eq!(line["same"], true);
    assert_eq!(line["name"], "amcl");
    assert!(line["level"].as_u64().unwrap() >= 20, "{line}");

    let states = ask(robot, "amcl/get_available_states", &json!({}));
    assert_eq!(states["available_states"].as_array().unwrap().len(), 11);
    let graph = ask(robot, "amcl/get_transition_graph", &json!({}));
    assert_eq!(graph["available_transitions"].as_array().unwrap().len(), 25);
    let here = ask(robot, "amcl/get_available_transitions", &json!({}));
    let label = |index: usize| &here["available_transitions"][index]["transition"]["label"];
    assert_eq!(
        (label(0), label(1)),
        (&json!("deactivate"), &json!("shutdown"))
    );

    // ros2 param list, get, describe and set.
    let listed = ask(
        robot,
        "amcl/list_parameters",
        &json!({ "prefixes": ["initial_pose"] }),
    );
    assert_eq!(listed["result"]["prefixes"], json!(["initial_pose"]));
    assert_eq!(listed["result"]["names"].as_array().unwrap().len(), 4);
    let names = json!({ "names": ["transform_tolerance", "scan_topic", "none"] });
    let got = ask(robot, "amcl/get_parameters", &names);
    assert_eq!(got["values"][0]["double_value"], 0.5);
    assert_eq!(got["values"][1]["string_value"], "scan");
    let types = ask(robot, "amcl/get_parameter_types", &names);
    assert_eq!(types["types"], json!([3, 4, 0]));
    let described = ask(robot, "amcl/describe_parameters", &names);
    let [first, second] = [0, 1].map(|index| &described["descriptors"][index]);
    assert_eq!(first["floating_point_range"][0]["to_value"], 10.0);
    assert_eq!(first["read_only"], false);
    assert_eq!(second["read_only"], true);
    let value = |name: &str, number: f64| json!({ "name": name, "value": { "type": 3, "double_value": number } });
    let text = json!({ "name": "scan_topic", "value": { "type": 4, "string_value": "other" } });
    let values =
        json!({ "parameters": [value("transform_tolerance", 0.25), text, value("z_hit", 0.4)] });
    robot.order("hear", json!({ "topic": "/parameter_events" }));
    let results = ask(robot, "amcl/set_parameters", &values);
    // The event names the parameters that were set, and no others.
    let event = robot.wait_for("/parameter_events");
    assert_eq!(event["same"], true);
    assert_eq!(event["node"], "/amcl");
    let changed = event["changed_parameters"].as_array().unwrap();
    let names: Vec<&Value> = changed.iter().map(|parameter| &parameter["name"]).collect();
    assert_eq!(names, ["transform_tolerance", "z_hit"]);
    assert_eq!(changed[0]["value"]["double_value"], 0.25);
    assert_eq!(event["new_parameters"], json!([]));
    let successful = |index: usize| &results["results"][index]["successful"];
    assert_eq!([0, 1, 2].map(successful), [true, false, true]);
    let together = ask(robot, "amcl/set_parameters_atomically", &values);
    assert_eq!(together["result"]["successful"], false);
    let one = json!({ "parameters": [value("laser_max_range", 20.0)] });
    ask(robot, "amcl/set_parameters_atomically", &one);
    // The rejected call caused no event.
    let event = robot.wait_for("/parameter_events");
    assert_eq!(event["changed_parameters"][0]["name"], "laser_max_range");
    joined.stop();
}
