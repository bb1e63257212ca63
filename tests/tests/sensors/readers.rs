//! Third-party tools and this project read each other's recordings alike.

use std::path::{Path, PathBuf};
use std::process::Command;

use recording::{Message, Recording};
use serde_json::{Value, json};
use tempfile::TempDir;
use tests::needs::Need;
use tests::recorded::{messages, record};
use tests::world::World;
use tests::{executables, python};

/// Versions of the Python readers that are compared with.
const READERS: [&str; 3] = ["mcap==1.6.0", "mcap-ros2-support==0.6.0", "rosbags==0.11.9"];

/// Returns the compared data: counts of all channels, and values of some.
fn as_we_read(path: &Path) -> Value {
    let recording = Recording::open(path).unwrap();
    let count = |c: &recording::Channel| (c.topic.to_string(), json!(c.messages));
    let counts: serde_json::Map<String, Value> = recording.channels().map(count).collect();
    let (mut scans, mut truths, mut odometry, mut maps) = (vec![], vec![], vec![], vec![]);
    for record in recording.records() {
        let record = record.unwrap();
        match record.message {
            Message::Scan(scan) => {
                let finite = scan.ranges.iter().filter(|range| range.is_finite());
                // Sums of millimetres as integers do not depend on their order.
                let sum: i64 = finite
                    .map(|range| (f64::from(*range) * 1000.0).round() as i64)
                    .sum();
                scans.push(json!([
                    scan.header.stamp.as_ns(),
                    scan.ranges.len(),
                    sum,
                    scan.header.frame_id
                ]));
            }
            Message::PoseStamped(pose) => {
                truths.push(json!([
                    record.log_time_ns,
                    pose.pose.position.x,
                    pose.pose.orientation.z
                ]));
            }
            Message::Odometry(message) => {
                odometry.push(json!([
                    message.pose.pose.position.x,
                    message.child_frame_id
                ]));
            }
            Message::Map(map) => {
                let sum: i64 = map.data.iter().map(|&cell| i64::from(cell)).sum();
                maps.push(json!([map.info.width, map.info.height, sum]));
            }
            Message::StaticTransforms(_) => {}
        }
    }
    json!({"counts": counts, "scans": scans, "truths": truths, "odometry": odometry, "maps": maps})
}

/// Prints the same data, by a third-party reader, as JSON.
const SCRIPT: &str = r#"
import json, math, sys
from collections import Counter
from pathlib import Path

reader, path = sys.argv[1:]
counts = Counter()
out = {"scans": [], "truths": [], "odometry": [], "maps": []}
own = {"votes": [], "hypotheses": [], "beams": [], "poses": [], "log": []}

def ns(stamp):
    return stamp.sec * 10**9 + stamp.nanosec

def take(topic, log_time, m):
    counts[topic] += 1
    if topic == "/scan":
        total = sum(int(math.floor(float(r) * 1000 + 0.5)) for r in m.ranges if math.isfinite(r))
        out["scans"].append([ns(m.header.stamp), len(m.ranges), total, m.header.frame_id])
    elif topic == "/ground_truth":
        out["truths"].append([log_time, m.pose.position.x, m.pose.orientation.z])
    elif topic == "/odom":
        out["odometry"].append([m.pose.pose.position.x, m.child_frame_id])
    elif topic == "/map":
        out["maps"].append([m.info.width, m.info.height, sum(int(c) for c in m.data)])
    elif topic == "/backcast/votes":
        own["votes"].append([m.counter, m.best, m.total, len(m.votes), m.votes[0].intensity])
    elif topic == "/backcast/hypotheses":
        best = m.hypotheses[0]
        own["hypotheses"].append([m.counter, m.verdict, m.best, best.map_from_laser.x, len(best.covariance)])
    elif topic == "/backcast/beams":
        own["beams"].append([m.counter, m.map_from_laser.x, len(m.beams), m.beams[0].range_m])
    elif topic == "/backcast/pose":
        own["poses"].append([m.counter, m.state, m.pose_known, m.map_from_laser.x, m.score, m.words])
    elif topic == "/rosout":
        own["log"].append([ns(m.stamp), m.level, m.name, m.msg])

if reader == "mcap":
    from mcap_ros2.reader import read_ros2_messages
    for m in read_ros2_messages(path):
        take(m.channel.topic, m.log_time_ns, m.ros_msg)
else:
    from rosbags.highlevel import AnyReader
    with AnyReader([Path(path)]) as bag:
        for connection, time, data in bag.messages():
            take(connection.topic, time, bag.deserialize(data, connection.msgtype))

out["counts"] = counts
print(json.dumps({"read": out, "own": own}))
"#;

fn python() -> Option<PathBuf> {
    python::with("readers", &READERS, "mcap_ros2, rosbags")
        .map_err(|why| Need::Python.is_missing("a reader of recordings", &why))
        .ok()
}

fn as_read_by(python: &Path, reader: &str, path: &Path) -> Value {
    let mut python = Command::new(python);
    tests::json_of(python.args(["-c", SCRIPT, reader]).arg(path))
}

#[test]
fn the_readers_of_others_agree() {
    let Some(python) = python() else {
        return;
    };
    let world = World::of("malaga_corridor");
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("a.mcap");
    record(&world.recording(), &world.map(), &path);
    let ours = as_we_read(&path);
    assert_eq!(ours["scans"].as_array().unwrap().len(), 37);
    let by_mcap = as_read_by(&python, "mcap", &path);
    let by_rosbags = as_read_by(&python, "rosbags", &path);
    assert_eq!(by_mcap["read"], ours, "mcap-ros2-support");
    assert_eq!(by_rosbags["read"], ours, "rosbags");
    // Our own messages are read by schemas that the readers have never seen.
    assert_eq!(by_mcap["own"], by_rosbags["own"]);
    for (number, votes) in by_mcap["own"]["votes"]
        .as_array()
        .unwrap()
        .iter()
        .enumerate()
    {
        assert_eq!(votes[0], number);
        assert_eq!(votes[2], votes[3], "all votes are there");
        assert_eq!(votes[1], votes[4], "the first is the best");
    }
    let said = by_mcap["own"]["log"].as_array().unwrap();
    let is_of = |line: &Value| line[2] == "recorder" && line[1] == 20;
    assert!(said.iter().any(is_of), "{said:?}");
    // The log starts before the recorder, with the launcher.
    let started = |line: &Value| {
        let text = line[3].as_str().unwrap();
        line[2] == "backcast" && text.starts_with("accumulator runs as process")
    };
    assert!(said.iter().any(started), "{said:?}");
    let beams = by_mcap["own"]["beams"].as_array().unwrap();
    assert!(beams.iter().all(|beam| beam[2] == 180), "{beams:?}");
    let tracked = by_mcap["own"]["poses"].as_array().unwrap();
    assert_eq!(tracked.len(), 37);
    // The tracker finds the place on the way, and has words for it.
    let (first, last) = (&tracked[0], &tracked[36]);
    assert_eq!((&first[1], &last[1]), (&json!(0), &json!(1)), "{tracked:?}");
    assert_eq!(last[2], true);
    assert!(!last[5].as_str().unwrap().is_empty(), "{last}");
    let poses = by_mcap["own"]["hypotheses"].as_array().unwrap();
    assert_eq!(poses.len(), 37);
    assert!(
        poses.iter().all(|pose| pose[1] == 1 && pose[4] == 9),
        "{poses:?}"
    );
}

/// Writes a recording again as a bag in SQLite.
const BAG_SCRIPT: &str = r#"
import sys
from pathlib import Path
from rosbags.highlevel import AnyReader
from rosbags.rosbag2 import StoragePlugin, Writer

recording, folder = Path(sys.argv[1]), Path(sys.argv[2])
with AnyReader([recording]) as reader:
    plugin = StoragePlugin.SQLITE3
    with Writer(folder, version=9, storage_plugin=plugin) as writer:
        known = {}
        for connection, time, data in reader.messages():
            if connection.topic not in known:
                known[connection.topic] = writer.add_connection(
                    connection.topic, connection.msgtype, typestore=reader.typestore)
            writer.write(known[connection.topic], time, data)
"#;

#[test]
fn bags_of_others_in_sqlite_read_as_the_recording() {
    let Some(python) = python() else {
        return;
    };
    let original = World::of("malaga_corridor").recording();
    let folder = TempDir::new().unwrap();
    let bag = folder.path().join("bag");
    let mut writer = Command::new(&python);
    let _ = tests::text_of(writer.args(["-c", BAG_SCRIPT]).args([&original, &bag]));
    assert_eq!(messages(&bag), messages(&original));

    let converted = folder.path().join("converted.mcap");
    let mut command = executables::backcast();
    let _ = tests::text_of(command.arg("convert").args([&bag, &converted]));
    assert_eq!(as_we_read(&converted), as_we_read(&original));
    let by_mcap = as_read_by(&python, "mcap", &converted);
    assert_eq!(by_mcap["read"], as_we_read(&original));
}
