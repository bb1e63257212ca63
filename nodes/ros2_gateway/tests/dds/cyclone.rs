//! A robot on Cyclone DDS.

use super::*;

/// Nodes on Cyclone DDS; none where it cannot be had.
pub(super) fn cyclone(domain: &str, namespace: &str) -> Option<Robot> {
    let python = python::with("cyclone", &["cyclonedds==11.0.1"], "cyclonedds.idl")
        .map_err(|why| Need::Python.is_missing("a robot on Cyclone DDS", &why))
        .ok()?;
    let mut command = Command::new(python);
    command.args(["-c", include_str!("cyclone.py"), domain, namespace]);
    Some(Robot::run(&mut command))
}

#[test]
fn nodes_on_cyclone_dds_feed_the_graph_and_get_the_pose() {
    let options = ["--as", "amcl", "--autostart"];
    let domain = domain();
    let Some(mut joined) = join_in(&domain, "dds-cyclone", "/r2", &options) else {
        return;
    };
    let Some(mut cyclone) = cyclone(&domain, "/r2") else {
        return;
    };
    let graph = &joined.graph;
    let maps = graph.subscriber::<topic::Map>().unwrap();
    cyclone.order("map", json!({ "width": 300, "height": 200 }));
    let map: MapHeader = wait_for(graph, &maps, |header, _| Some(*header));
    assert_eq!((map.width, map.height), (300, 200));

    // The odometry comes as a transform, and so does the laser's place.
    let frames = json!([["base_link", "laser", 0.5]]);
    cyclone.order(
        "frames",
        json!({ "topic": "tf_static", "ns": START_NS, "frames": frames }),
    );
    let mut last = START_NS;
    let (header, ranges, odometry) = until_both(graph, |since| {
        last = START_NS + since;
        let frames = json!([["odom", "base_link", 1.5]]);
        let transforms = json!({ "topic": "tf", "ns": last, "frames": frames });
        cyclone.order("frames", transforms);
        cyclone.order("drive", json!({ "ns": last, "beams": BEAMS }));
    });
    assert_eq!((ranges.len(), ranges[1]), (BEAMS, 1.01));
    assert_eq!(header.base_from_laser, pose2(0.5, 0.0, 0.0));
    assert_eq!(odometry.odom_from_child, pose2(1.5, 0.0, 0.0));

    let hints = graph.subscriber::<topic::InitialPoseTopic>().unwrap();
    cyclone.order("click", json!({ "ns": START_NS, "x": 3.0, "y": 1.0 }));
    let hint = wait_for(graph, &hints, |hint, _| Some(hint.map_from_base));
    assert_eq!(hint, pose2(3.0, 1.0, 0.0));

    // The pose, its transform, and what a master control gets.
    let poses = poses_of(graph);
    for topic in ["tf", "amcl_pose", "localization/vda5050"] {
        cyclone.order("subscribe", json!({ "topic": topic }));
    }
    let mut seen = std::collections::BTreeMap::new();
    for counter in 0.. {
        let header = PoseHeader {
            stamp: Stamp {
                measured_ns: last + counter,
                ..stamp(counter as u64)
            },
            map_from_odom: pose2(1.5, 1.0, 0.0),
            ..tracked()
        };
        poses.send(header, &[]).unwrap();
        let said = cyclone.receive();
        let event = said["event"].as_str().unwrap().to_owned();
        let message = said["message"].clone();
        if event != "tf" || message["transforms"][0]["header"]["frame_id"] == "map" {
            seen.insert(event, message);
        }
        if seen.len() == 3 {
            break;
        }
    }
    assert_eq!(seen["amcl_pose"]["pose"]["pose"]["position"]["x"], 3.0);
    let transform = &seen["tf"]["transforms"][0];
    assert_eq!(transform["child_frame_id"], "odom");
    assert_eq!(transform["transform"]["translation"]["x"], 1.5);
    let position = seen["localization/vda5050"]["data"].as_str().unwrap();
    let position: serde_json::Value = serde_json::from_str(position).unwrap();
    assert_eq!(position["x"], 3.0);
    assert_eq!(position["localized"], true);
    joined.stop();
}
