//! The graph and `backcast evaluate`, which uses the engine alone, have the same results on
//! recordings of other robots, if these are available.

use std::path::Path;
use std::process::Command;

use recording::Recording;
use serde_json::Value;
use tempfile::TempDir;
use tests::executables;
use tests::recorded::graph;

/// Independent scans of two buildings.
const FILES: [&str; 2] = ["fr079_queries.mcap", "seattle_queries.mcap"];

/// Counts that both report.
const COUNTS: [&str; 6] = [
    "truths",
    "success_50cm_10deg",
    "success_20cm_3deg",
    "top16_recall",
    "unique",
    "unique_wrong",
];

/// Errors that both report, with their percentiles. True headings take another way through angles
/// in the graph, which changes their last bits.
const ERRORS: [&str; 4] = [
    "/error_m/median",
    "/error_m/p90",
    "/error_deg/median",
    "/error_deg/p90",
];
const ROUNDING: f64 = 1e-9;

/// Returns the last line that a command prints, as JSON.
fn last_line(command: &mut Command) -> Value {
    tests::json_lines_of(command).pop().unwrap()
}

fn of_graph(recording: &Path, folder: &TempDir) -> Value {
    let map = Recording::open(recording).unwrap().map().unwrap().unwrap();
    let yaml = folder.path().join("map.yaml");
    map::save(&map, &yaml).unwrap();
    let descriptor = folder.path().join("graph.yaml");
    std::fs::write(&descriptor, graph(recording, &yaml)).unwrap();
    let mut command = executables::backcast();
    let line = last_line(
        command
            .args(["run", "--json", "--rate", "max"])
            .arg(descriptor),
    );
    line["summary"].clone()
}

#[test]
fn the_graph_finds_what_evaluate_finds() {
    let Some(data) = tests::evaluation_data("the_graph_finds_what_evaluate_finds") else {
        return;
    };
    for file in FILES {
        let recording = data.join(file);
        let folder = TempDir::new().unwrap();
        let by_graph = of_graph(&recording, &folder);
        let mut command = executables::backcast();
        let by_engine = last_line(command.args(["evaluate", "--json"]).arg(&recording));
        for count in COUNTS {
            assert!(by_engine[count].is_number(), "{file}: {count}");
            assert_eq!(by_graph[count], by_engine[count], "{file}: {count}");
        }
        for error in ERRORS {
            let of = |found: &Value| found.pointer(error).unwrap().as_f64().unwrap();
            let (graph, engine) = (of(&by_graph), of(&by_engine));
            assert!(
                (graph - engine).abs() < ROUNDING,
                "{file}: {graph} {engine}"
            );
        }
        assert_eq!(by_graph["answered"], by_engine["scans"], "{file}");
        assert_eq!(by_graph["dropped"], 0, "{file}");
    }
}

#[test]
fn a_public_building_is_found() {
    let Some(data) = tests::evaluation_data("a_public_building_is_found") else {
        return;
    };
    let mut command = executables::backcast();
    command.args(["evaluate", "--every", "4", "--json"]);
    let found = last_line(command.arg(data.join("intel_queries.mcap")));
    assert_eq!(found["truths"], 50);
    let success = found["success_50cm_10deg"].as_f64().unwrap();
    assert!(success >= 0.90, "{found}");
}
