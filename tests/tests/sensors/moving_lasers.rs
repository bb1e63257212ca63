//! Scans that take time, and several lasers: the graph and the tools bring them to one time by the
//! same odometry, and have the same results.

use std::path::Path;

use messages::Verdict;
use tempfile::TempDir;
use tests::world::World;
use tests::{answers, executables};

/// A drive through the corridor with turns in it.
const PATH: &str = "9,-10.9 10.5,-10.6 9,-10.9";

fn backcast(arguments: &[&str]) -> String {
    tests::text_of(executables::backcast().args(arguments))
}

fn simulated(folder: &TempDir, lasers: &[&str]) -> String {
    let recording = folder.path().join("r.mcap").to_str().unwrap().to_owned();
    let map = World::of("malaga_corridor").map();
    let always = ["simulate", "--map", map.to_str().unwrap(), "--path", PATH];
    let timed = ["--rate", "4", "--scan-duration", "0.1", "--out", &recording];
    let _ = backcast(&[&always[..], lasers, &timed[..]].concat());
    recording
}

/// Verdict, x, y and yaw of each scan's best place.
type Places = Vec<(String, f64, f64, f64)>;

fn by_tools(recording: &str, topics: &[&str]) -> Places {
    let lines = backcast(&[&["locate", "--json", "--bag", recording], topics].concat());
    let places = lines.lines().map(|line| {
        let line: serde_json::Value = serde_json::from_str(line).unwrap();
        let best = &line["laser"];
        let number = |key: &str| best[key].as_f64().unwrap();
        let verdict = line["verdict"].as_str().unwrap().to_owned();
        (verdict, number("x"), number("y"), number("yaw"))
    });
    places.collect()
}

fn by_graph(
    tag: &str,
    recording: &str,
    topics: &[&str],
    accumulator: &[&str],
    scans: usize,
) -> Places {
    let always = [
        "--rate",
        "max",
        "--wait-for",
        "accumulator,peak_extractor",
        "--recording",
        recording,
    ];
    let player = [&always[..], topics].concat();
    let map = World::of("malaga_corridor").map();
    let map: &Path = &map;
    let answers = answers::of_graph_fed_by(tag, map, scans, accumulator, &player);
    assert!(
        answers
            .votes
            .iter()
            .all(|(votes, _)| votes.has_readings == 1)
    );
    let places = answers.hypotheses.iter().map(|(header, items)| {
        let verdict = Verdict::from_code(header.verdict).unwrap().to_string();
        let best = items[0].map_from_laser;
        (verdict, best.x, best.y, best.yaw)
    });
    places.collect()
}

#[test]
fn the_motion_within_scans_is_taken_out_alike() {
    let folder = TempDir::new().unwrap();
    let recording = simulated(&folder, &["--mount", "0.3,0.1,20"]);
    let tools = by_tools(&recording, &[]);
    assert!(tools.len() > 10, "{tools:?}");
    let graph = by_graph("moving", &recording, &[], &[], tools.len());
    assert_eq!(graph, tools);
    let left_in = by_tools(&recording, &["--deskew", "false"]);
    assert_ne!(left_in, tools, "the robot moves");
}

#[test]
fn two_lasers_are_joined_alike() {
    let folder = TempDir::new().unwrap();
    let lasers = [
        "--laser",
        "front=0.49,0,0",
        "--laser",
        "rear=-0.43,0,180,180",
    ];
    let recording = simulated(&folder, &lasers);
    let topics = ["--scan-topic", "/front/scan", "--scan-topic", "/rear/scan"];
    let tools = by_tools(&recording, &topics);
    assert!(tools.len() > 10, "{tools:?}");
    assert!(
        tools.iter().all(|(verdict, ..)| verdict == "Unique"),
        "{tools:?}"
    );
    let joining = ["--scans", "front,rear"];
    let graph = by_graph("joined", &recording, &topics, &joining, tools.len());
    assert_eq!(graph, tools);
}
