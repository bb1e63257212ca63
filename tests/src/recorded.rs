//! A graph that plays a recording, and the recording made of it.

use std::collections::BTreeMap;
use std::path::Path;

use recording::Recording;

use crate::executables;

/// Plays `recording` through a graph that also tracks the pose, with the executables of this test
/// run, and records it to `output`.
pub fn record(recording: &Path, map: &Path, output: &Path) {
    let descriptor = output.with_extension("yaml");
    std::fs::write(&descriptor, tracking_graph(recording, map)).unwrap();
    let mut command = executables::backcast();
    command.arg("run").arg(&descriptor);
    let _ = crate::text_of(command.args(["--rate", "max", "--record"]).arg(output));
}

/// Returns the descriptor of a graph that plays `recording`, with the executables of this test run.
pub fn graph(recording: &Path, map: &Path) -> String {
    graph_with(recording, map, "")
}

/// Adds a tracker that uses odometry.
fn tracking_graph(recording: &Path, map: &Path) -> String {
    let tracker = executables::path("tracker");
    let graph = graph(recording, map).replace(
        "--wait-for accumulator,peak_extractor",
        "--wait-for accumulator,peak_extractor,tracker",
    );
    format!(
        "{graph}  - id: tracker
    path: {}
    inputs:
      scan: replayer/scan
      odometry: replayer/odometry
      map: map_server/map
      hypotheses: peak_extractor/hypotheses
    outputs: [pose]
",
        tracker.display()
    )
}

/// Like [`graph`], with further lines for the accumulator, each indented by four.
pub fn graph_with(recording: &Path, map: &Path, accumulator: &str) -> String {
    let path = |name: &str| executables::path(name).display().to_string();
    let (recording, map) = (recording.display(), map.display());
    format!(
        "nodes:
  - id: replayer
    path: {}
    args: --recording {recording} --wait-for accumulator,peak_extractor
    inputs: {{ hypotheses: peak_extractor/hypotheses }}
    outputs: [scan, odometry, ground_truth]
  - id: map_server
    path: {}
    args: --map {map}
    outputs: [map]
  - id: boundary_extractor
    path: {}
    inputs: {{ map: map_server/map }}
    outputs: [boundary]
  - id: accumulator
    path: {}
    inputs:
      scan: replayer/scan
      map: map_server/map
      boundary: boundary_extractor/boundary
    outputs: [votes, field]
{accumulator}  - id: peak_extractor
    path: {}
    inputs:
      votes: accumulator/votes
      scan: replayer/scan
      map: map_server/map
    outputs: [hypotheses, beams]
",
        path("replayer"),
        path("map_server"),
        path("boundary_extractor"),
        path("accumulator"),
        path("peak_extractor"),
    )
}

/// Returns the messages of a recording by topic: log times and bytes, in order.
pub fn messages(path: &Path) -> BTreeMap<String, Vec<(i64, Vec<u8>)>> {
    let recording = Recording::open(path).unwrap();
    assert_eq!(recording.damage(), None);
    let mut messages: BTreeMap<String, Vec<_>> = BTreeMap::new();
    for record in recording.raw_records() {
        let record = record.unwrap();
        let topic = messages
            .entry(record.channel.topic.to_string())
            .or_default();
        topic.push((record.log_time_ns, record.body));
    }
    messages
}
