//! The tracker in the graph and in `backcast evaluate --sequence` has the same poses to the last
//! bit, and searching on demand changes none of them.

use std::path::Path;
use std::process::Command;
use std::time::{Duration, Instant};

use messages::{PoseHeader, TrackState, topic};
use serde_json::Value;
use tempfile::TempDir;
use tests::needs::Need;
use tests::world::World;
use tests::{executables, python};
use transport::testing::Isolated;
use transport::{Flow, TransportError};

/// Stamp, x, y, and the quaternion's z and w.
type Track = Vec<(String, f64, f64, f64, f64)>;

fn by_tools(recording: &Path, map: &Path) -> Track {
    let folder = TempDir::new().unwrap();
    let mut command = executables::backcast();
    command.args("evaluate --sequence --starts 1 --kidnaps 0 --map".split(' '));
    command.arg(map).arg("--trajectories").arg(folder.path());
    let _ = tests::text_of(command.arg(recording));
    let text = std::fs::read_to_string(folder.path().join("recording.tum")).unwrap();
    let line = |line: &str| {
        let words: Vec<&str> = line.split(' ').collect();
        let [x, y, z, w] = [1, 2, 6, 7].map(|i| words[i].parse().unwrap());
        (words[0].to_owned(), x, y, z, w)
    };
    text.lines().map(line).collect()
}

/// Time without a pose after which the rest counts as lost, so that a test that misses one fails
/// and does not wait forever.
const SILENCE: Duration = Duration::from_secs(60);

/// Returns the poses of all scans, from a graph that is fed at a rate; `map` holds options of its
/// server.
pub(super) fn by_graph(
    tag: &str,
    (recording, map): (&Path, &[&str]),
    (rate, search): (&str, &str),
    tracker: &[&str],
    scans: usize,
) -> Vec<PoseHeader> {
    let isolated = Isolated::new(tag);
    let graph = isolated.join("test");
    let poses = graph.subscriber::<topic::Tracked>().unwrap();
    let start = |name: &str, arguments: &[&str]| executables::start(name, &graph, arguments);
    let nodes = [
        start("map_server", map),
        start("boundary_extractor", &[]),
        start("accumulator", &["--search", search]),
        start("peak_extractor", &[]),
        start("tracker", tracker),
    ];
    let recording = recording.to_str().unwrap();
    let wait = "accumulator,peak_extractor,tracker";
    let player = start(
        "replayer",
        &["--rate", rate, "--wait-for", wait, "--recording", recording],
    );
    let mut found: Vec<PoseHeader> = Vec::new();
    let mut last_came = Instant::now();
    let outcome = graph.run(&[&poses], Duration::from_millis(100), |_| {
        while let Some(pose) = poses.receive()? {
            if pose.header().from_scan == 1 {
                found.push(*pose.header());
                last_came = Instant::now();
            }
        }
        let is_over = found.len() == scans || last_came.elapsed() > SILENCE;
        Ok::<_, TransportError>(if is_over { Flow::Stop } else { Flow::Continue })
    });
    outcome.unwrap();
    match search {
        "all" => assert_eq!(player.exit_code(), Some(0), "the player lost something"),
        // It may wait for the answer to a last scan that is not searched.
        _ => player.stop(),
    }
    for node in nodes {
        node.stop();
    }
    found
}

/// Returns the poses that a trajectory contains.
fn track(poses: &[PoseHeader]) -> Track {
    let states = [TrackState::Unique as u32, TrackState::Doubtful as u32];
    let meant = poses.iter().filter(|pose| states.contains(&pose.state));
    meant
        .map(|pose| {
            let (stamp, at) = (pose.stamp.measured_ns, pose.map_from_laser);
            let (sin, cos) = (0.5 * at.yaw).sin_cos();
            let stamp = format!("{}.{:09}", stamp / 1_000_000_000, stamp % 1_000_000_000);
            (stamp, at.x, at.y, sin, cos)
        })
        .collect()
}

#[test]
fn the_graph_and_the_tools_track_alike() {
    let world = World::of("malaga_corridor");
    let (recording, map) = (world.recording(), world.map());
    let expected = by_tools(&recording, &map);
    let map = ["--map", map.to_str().unwrap()];
    let poses = by_graph("track-all", (&recording, &map), ("max", "all"), &[], 37);
    assert!(expected.len() > 25, "{}", expected.len());
    assert_eq!(track(&poses), expected);
    // With odometry, the map's frame is tied to the odometry's.
    assert!(poses.iter().all(|pose| pose.odom_known == 1));
    let asked = by_graph("track-asked", (&recording, &map), ("4", "asked"), &[], 37);
    assert_eq!(track(&asked), expected);
}

/// evo requires many packages that are not needed to read and compare two files.
const EVO: [&str; 5] = [
    "--no-deps",
    "evo==1.31.1",
    "numpy==2.4.6",
    "scipy==1.17.1",
    "packaging==26.4",
];

#[test]
fn evo_finds_the_same_errors_of_a_trajectory() {
    let test = "evo_finds_the_same_errors_of_a_trajectory";
    let python = match python::with("evo", &EVO, "evo.core.metrics, evo.core.sync") {
        Ok(python) => python,
        Err(why) => return Need::Python.is_missing(test, &why),
    };
    let world = World::of("malaga_campus");
    let (folder, map) = (TempDir::new().unwrap(), world.map());
    let written = folder.path().to_str().unwrap();
    let once = ["--starts", "1", "--kidnaps", "0", "--trajectories", written];
    let options = [&once[..], &["--map", map.to_str().unwrap()]].concat();
    let ours = &figures(&world.recording(), &options)["from_first_scan"];
    let script = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/tests/localization/trajectory_errors.py"
    );
    let files = ["recording_truth.tum", "recording.tum"].map(|file| folder.path().join(file));
    let theirs = tests::json_of(Command::new(python).arg(script).args(files));
    assert!(theirs["poses"].as_u64().unwrap() > 100, "{theirs}");
    assert_eq!(ours["poses"], theirs["poses"]);
    for error in ["ape_m", "rpe_m", "rpe_deg"] {
        for figure in ["rmse", "median", "max"] {
            let [ours, theirs] = [ours, &theirs].map(|all| all[error][figure].as_f64().unwrap());
            // Quaternions and matrices are in double precision; angles come from their cosine,
            // which is flat near zero.
            assert!(
                (ours - theirs).abs() < 1e-6,
                "{error} {figure}: {ours} {theirs}"
            );
        }
    }
}

pub(super) fn figures(recording: &Path, options: &[&str]) -> Value {
    let mut command = executables::backcast();
    command.args(["evaluate", "--sequence", "--json"]);
    tests::json_of(command.args(options).arg(recording))
}

#[test]
fn drives_of_other_robots_are_tracked() {
    let Some(folder) = tests::evaluation_data("drives_of_other_robots_are_tracked") else {
        return;
    };
    for (file, right) in [
        ("intel_sequence.mcap", 0.98),
        ("seattle_sequence.mcap", 0.9),
    ] {
        let found = figures(&folder.join(file), &["--starts", "20", "--kidnaps", "10"]);
        assert_eq!(found["wrong_starts"], 0, "{file}: {found}");
        assert_eq!(found["losses"], 0, "{file}: {found}");
        assert_eq!(found["kidnaps_wrong"], 0, "{file}: {found}");
        let within = found["right"]["5"].as_f64().unwrap();
        assert!(within >= right, "{file}: {found}");
        assert!(found["rms_m"].as_f64().unwrap() <= 0.03, "{file}: {found}");
    }
    // A drawn map lacks doors, and its bays repeat.
    let drawn = folder.join("guardian_drawn_map.mcap");
    let options = ["--starts", "20", "--kidnaps", "0", "--every", "2"];
    let found = figures(&drawn, &options);
    assert_eq!(found["wrong_starts"], 0, "{found}");
    assert!(found["right"]["20"].as_f64().unwrap() >= 0.8, "{found}");
}
