//! Tests of `backcast simulate`: its recordings can be located, and impossible drives are refused.

use recording::Recording;
use serde_json::Value;
use tempfile::TempDir;

use crate::drawn::{assert_refused, output, recordings, run};

const START_NS: i64 = 1_700_000_000_000_000_000;

/// Path along the recorded corridor and into a turn.
const CORRIDOR: &str = "3.5,-10.4 6.5,-10.9 9,-10.9 14.5,-10.3";

/// Creates a folder with a simulated recording `r.mcap`.
fn simulated(options: &str) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    let stdout = output(folder.path(), &simulate(options));
    assert!(stdout.starts_with("r.mcap: "), "{stdout}");
    folder
}

fn simulate(options: &str) -> String {
    let map = recordings().join("malaga_corridor/map.yaml");
    format!("simulate --map {} --out r.mcap {options}", map.display())
}

fn evaluate(folder: &TempDir, options: &str) -> Value {
    let line = format!("evaluate --json {options} r.mcap");
    let (code, stdout, stderr) = run(folder.path(), &line);
    assert_eq!(code, 0, "{stderr}");
    serde_json::from_str(&stdout).unwrap()
}

#[test]
fn each_scan_of_a_laser_is_found_where_it_was_taken() {
    let folder = simulated(&format!(
        "--path '{CORRIDOR}' --rate 1 --people 3 --outliers 0.02 --mount 0.4,0,0"
    ));
    let judged = evaluate(&folder, "");
    // 11.2 m at 0.5 m/s and some turns, one scan per second.
    assert!(judged["scans"].as_u64().unwrap() > 20, "{judged}");
    assert_eq!(judged["truths"], judged["scans"]);
    assert_eq!(judged["success_20cm_3deg"], 1.0, "{judged}");
    assert_eq!(judged["unique_wrong"], 0.0, "{judged}");
    // Readings end at the edge of a cell, but the fit uses its middle: half a cell of 5 cm along
    // each axis, plus noise. The limit is one cell.
    let median_m = judged["error_m"]["median"].as_f64().unwrap();
    assert!(median_m < 0.05, "{judged}");
}

#[test]
fn two_lasers_back_to_back_show_what_one_may_not() {
    // The rear laser is upside down, according to its mount on /tf_static.
    let folder = simulated(&format!(
        "--path '{CORRIDOR}' --rate 1 --laser front=0.49,0,0 --laser rear=-0.43,0,180,180 --range-max 3"
    ));
    let joined = evaluate(&folder, "--scan-topic /front/scan --scan-topic /rear/scan");
    let alone = evaluate(&folder, "--scan-topic /front/scan");
    assert_eq!(joined["truths"], joined["scans"], "{joined}");
    assert_eq!(joined["success_20cm_3deg"], 1.0, "{joined}");
    assert_eq!(joined["unique_wrong"], 0.0, "{joined}");
    let unique = |judged: &Value| judged["unique"].as_u64().unwrap();
    assert!(
        unique(&joined) > unique(&alone),
        "within 3 m one laser sees less: {joined} {alone}"
    );
}

#[test]
fn a_lidar_tracks_as_well_as_its_middle_ring() {
    let folder = simulated(&format!(
        "--path '{CORRIDOR}' --rings 16 --field-of-view 360 --beams 720 --scan-duration 0.1"
    ));
    let followed = |topic: &str| {
        let judged = evaluate(&folder, &format!("--sequence --starts 4 {topic}"));
        assert_eq!(judged["wrong_scans"], 0, "{judged}");
        judged["rms_m"].as_f64().unwrap()
    };
    let [ring, band] = ["--scan-topic /scan", "--cloud-topic /points"].map(followed);
    assert!(band < 1.1 * ring, "{band} and {ring}");
}

#[test]
fn the_topics_are_those_of_a_robot() {
    let folder = simulated("--path '4,-10.5 5,-10.6' --rate 2 --sonar --mount 0.1,0,0");
    let recording = Recording::open(folder.path().join("r.mcap")).unwrap();
    let counts = recording.channels();
    let counts = counts.map(|channel| (channel.topic.to_string(), channel.messages));
    let counts: Vec<_> = counts.collect();
    // 1.005 m at 0.5 m/s, twice per second, and one at the start.
    let expected = [
        ("/map", 1),
        ("/tf_static", 1),
        ("/odom", 5),
        ("/ground_truth", 5),
        ("/scan", 5),
    ];
    assert_eq!(counts.len(), expected.len());
    for (topic, messages) in expected {
        assert!(counts.contains(&(topic.to_owned(), messages)), "{counts:?}");
    }
    let mount = recording.base_from_laser("laser").unwrap().unwrap();
    assert_eq!(mount.base_from_laser.x, 0.1);
    let first = recording.records().next().unwrap().unwrap();
    assert_eq!(first.log_time_ns, START_NS);
}

#[test]
fn what_cannot_be_driven_is_refused_and_nothing_is_written() {
    let folder = tempfile::tempdir().unwrap();
    const WAY: &str = "--path '4,-10.5 5,-10.5'";
    let refused = |options: &str, code: i32, message: &str| {
        assert_refused(folder.path(), &simulate(options), code, message);
        assert!(!folder.path().join("r.mcap").exists(), "{options}");
    };
    refused("--path '4,-10.5 400,0'", 1, "corner 2 of the path, 400,0,");
    refused("--path '4,-10.5 4,-14'", 1, "meets an obstacle at 4.00,");
    refused("--path '4,-10.5'", 2, "1 corners; allowed are 2");
    let both = "cannot be used with";
    for (options, code, message) in [
        ("--noise x", 2, "\"x\" is not a noise"),
        ("--sonar --beams 9", 2, both),
        ("--beam-width 9", 2, "--sonar"),
        ("--laser a=0,0,0 --mount 0,0,0", 2, both),
        (
            "--laser a=0,0,0 --laser a=1,0,0",
            1,
            "two lasers are called",
        ),
    ] {
        refused(&format!("{WAY} {options}"), code, message);
    }
}
