//! Scans that take time, and several lasers: the graph and the tools bring them to one time by the
//! same odometry, and have the same results.

use std::path::Path;

use messages::Verdict;
use tempfile::TempDir;
use tests::world::World;
use tests::{answers, executables};

/// A drive through the corridor with turns in it.
const PATH: &str = "9,-10.9 10.5,-10.6 9,-10.9";

fn simulated(folder: &TempDir, lasers: &str) -> String {
    let recording = folder.path().join("r.mcap").to_str().unwrap().to_owned();
    let map = World::of("malaga_corridor").map();
    let always = ["simulate", "--map", map.to_str().unwrap(), "--path", PATH];
    let timed = ["--rate", "4", "--scan-duration", "0.1", "--out", &recording];
    let mut simulate = executables::backcast();
    let _ = tests::text_of(simulate.args(always).args(lasers.split(' ')).args(timed));
    recording
}

/// Verdict, x, y and yaw of each scan's best place.
type Places = Vec<(String, f64, f64, f64)>;

fn by_tools(recording: &str, topics: &[&str]) -> Places {
    let mut locate = executables::backcast();
    locate.args(["locate", "--json", "--bag", recording]);
    let lines = tests::json_lines_of(locate.args(topics));
    let places = lines.iter().map(|line| {
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
    let (recording, map) = (Path::new(recording), World::of("malaga_corridor").map());
    let answers = answers::of_graph(tag, recording, &map, scans, accumulator, topics);
    let mut votes = answers.votes.iter();
    assert!(votes.all(|(votes, _)| votes.has_readings == 1));
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
    let recording = simulated(&folder, "--mount 0.3,0.1,20");
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
    let lasers = "--laser front=0.49,0,0 --laser rear=-0.43,0,180,180";
    let recording = simulated(&folder, lasers);
    let topics = ["--scan-topic", "/front/scan", "--scan-topic", "/rear/scan"];
    let tools = by_tools(&recording, &topics);
    assert!(tools.len() > 10, "{tools:?}");
    let are_unique = tools.iter().all(|(verdict, ..)| verdict == "Unique");
    assert!(are_unique, "{tools:?}");
    let joining = ["--scans", "front,rear"];
    let graph = by_graph("joined", &recording, &topics, &joining, tools.len());
    assert_eq!(graph, tools);
}
