//! Tests of `backcast evaluate` as a process, on drawn and on real recordings.

use std::fs;
use std::path::Path;

use geometry::Pose;
use recording::Message;
use serde_json::Value;
use tempfile::TempDir;
use tests::assert_ends;

use crate::drawn::{
    BASE_FROM_LASER, HERE, SECOND_NS, THERE, assert_names, assert_refused, map_from_laser,
    map_message, mount_message, output, parsed, record, recordings, run, scan, scan_at, truth_at,
};

/// Creates a folder with `r.mcap`: a map and five scans. The second has no ground truth, the third
/// is empty, and the ground truth of the last is that of another place.
fn folder() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    let mut empty = scan(3, HERE);
    empty.ranges.clear();
    record(
        &folder.path().join("r.mcap"),
        &[
            map_message(),
            scan_at(1, HERE),
            truth_at(1, HERE),
            scan_at(2, HERE),
            ("/scan", Message::Scan(empty)),
            truth_at(3, HERE),
            truth_at(4, THERE),
            scan_at(4, THERE),
            scan_at(5, THERE),
            truth_at(5, HERE),
        ],
    );
    folder
}

fn counts(object: &Value, keys: [&str; 2]) -> [u64; 2] {
    keys.map(|key| object[key].as_u64().unwrap())
}

/// Evaluates `r.mcap` with remarks, if any; returns its object.
fn judged(folder: &Path, options: &str) -> Value {
    let (code, stdout, stderr) = run(folder, &format!("evaluate --json {options} r.mcap"));
    assert_eq!(code, 0, "{stderr}");
    parsed(&stdout).remove(0)
}

#[test]
fn the_object_counts_what_was_found() {
    let (code, stdout, stderr) = run(folder().path(), "evaluate --json r.mcap");
    assert_eq!(code, 0, "{stderr}");
    let object = &parsed(&stdout)[0];
    assert_eq!(object["bag"], "r.mcap");
    assert_eq!(object["map_cells"], 240);
    // Cells of walls are not searchable.
    let searchable = object["searchable_cells"].as_u64().unwrap();
    assert!((1..240).contains(&searchable), "{searchable}");
    assert!(object["index_bytes"].as_u64().unwrap() > 0);
    assert_eq!(counts(object, ["scans", "truths"]), [5, 4]);
    assert_eq!(object["success_50cm_10deg"], 0.5);
    assert_eq!(object["top16_recall"], 0.5);
    assert_eq!(object["unique"], 3);
    assert_eq!(object["unique_wrong"], 1);
    let said = object["probabilities"].as_array().unwrap();
    let sum = |key: &str| -> u64 { said.iter().map(|said| said[key].as_u64().unwrap()).sum() };
    assert_eq!(
        (sum("answers"), sum("right")),
        (3, 2),
        "of the scan that was refused nothing was said"
    );
    // Errors are computed for successes only, so they are within half a metre.
    assert!(object["error_m"]["p90"].as_f64().unwrap() <= 0.5);
    for key in ["prepare_cpu_ms", "peak_rss_mb"] {
        assert!(object[key].as_f64().unwrap() > 0.0, "{key}");
    }
    assert!(object["cpu_ms"]["median"].as_f64() <= object["cpu_ms"]["max"].as_f64());
    assert_eq!(
        stderr,
        "backcast: r.mcap: scans rejected: 1; the first: the scan is empty: it has no ranges\n"
    );
}

#[test]
fn of_the_scans_taken_those_with_a_truth_are_judged() {
    let folder = folder();
    for (every, taken) in [(3, [2, 2]), (100, [1, 1])] {
        let object = judged(folder.path(), &format!("--every {every}"));
        assert_eq!(object["success_50cm_10deg"], 1.0);
        assert_eq!(counts(&object, ["scans", "truths"]), taken, "{every}");
    }
}

#[test]
fn a_file_that_cannot_be_evaluated_does_not_keep_the_others() {
    let folder = folder();
    let path = |name: &str| folder.path().join(name);
    let bytes = fs::read(path("r.mcap")).unwrap();
    fs::write(path("cut.mcap"), &bytes[..bytes.len() - 4]).unwrap();
    let (map, scan, truth) = (map_message, || scan_at(1, HERE), |at| truth_at(at, HERE));
    record(&path("untrue.mcap"), &[map(), scan()]);
    record(&path("other.mcap"), &[map(), scan(), truth(2)]);
    record(&path("mapless.mcap"), &[scan(), truth(1)]);
    record(&path("blind.mcap"), &[map(), truth(1)]);
    let (code, stdout, stderr) = run(
        folder.path(),
        "evaluate --json none.mcap cut.mcap untrue.mcap other.mcap mapless.mcap blind.mcap \
         r.mcap --every 4",
    );
    assert_eq!(code, 1, "{stderr}");
    let [object] = &parsed(&stdout)[..] else {
        panic!("{stdout}");
    };
    assert_eq!(object["bag"], "r.mcap");
    let expected = [
        "backcast: cannot read the recording none.mcap: No such file",
        "backcast: cut.mcap: the file is cut short",
        "backcast: untrue.mcap has no true poses on /ground_truth",
        "backcast: other.mcap: none of the 1 scans taken has a true pose; the file holds 1,",
        "backcast: mapless.mcap has no map on /map: name one with --map map.yaml",
        "backcast: blind.mcap has no sensor_msgs/msg/LaserScan; it has /",
    ];
    let said: Vec<&str> = stderr.lines().collect();
    assert_eq!(said.len(), expected.len(), "{stderr}");
    for (line, expected) in said.iter().zip(expected) {
        assert!(line.starts_with(expected), "{line}");
    }
}

#[test]
fn requirements_of_several_files_are_reported_with_their_total() {
    let folder = folder();
    let path = |name: &str| folder.path().join(name);
    let sound = [map_message(), scan_at(1, HERE), truth_at(1, HERE)];
    record(&path("s.mcap"), &sound);
    let evaluate = |options: &str| run(folder.path(), &format!("evaluate {options}"));
    let required = "--min-truths 2 --min-unique 80";
    let (code, stdout, stderr) = evaluate(&format!(
        "--json {required} --junit out/e.xml r.mcap s.mcap none.mcap"
    ));
    assert_eq!(code, 1, "{stderr}");
    let objects = parsed(&stdout);
    assert_eq!(objects.len(), 3, "{stdout}");
    let total = &objects[2]["total"];
    assert_eq!(counts(total, ["truths", "unique"]), [5, 4]);
    assert_eq!(total["success_50cm_10deg"], 0.6);
    for said in [
        "r.mcap: Unique are 75.0 %, --min-unique 80",
        "s.mcap: true poses are 1, --min-truths 2",
    ] {
        assert!(stderr.contains(said), "{said}: {stderr}");
    }
    let report = fs::read_to_string(path("out/e.xml")).unwrap();
    assert!(report.contains("failures=\"2\" errors=\"1\""), "{report}");
    let again = evaluate("--junit out/e.xml s.mcap");
    assert_ends(again, 2, "out/e.xml is there already");
    let (code, _, stderr) = evaluate(&format!(
        "{required} --total --junit out/e.xml --force r.mcap s.mcap"
    ));
    assert_eq!(code, 0, "{stderr}");
}

#[test]
fn truths_at_a_rate_of_their_own_are_interpolated() {
    let folder = tempfile::tempdir().unwrap();
    let messages = [
        map_message(),
        truth_at(1, HERE),
        scan_at(2, HERE),
        truth_at(3, HERE),
    ];
    record(&folder.path().join("r.mcap"), &messages);
    let hint = "`evaluate --truth-gap-s`";
    assert_refused(folder.path(), "evaluate r.mcap", 1, hint);
    let object = judged(folder.path(), "--truth-gap-s 2");
    assert_eq!(counts(&object, ["truths", "unique"]), [1, 1]);
}

#[test]
fn wrong_use_is_reported() {
    let folder = tempfile::tempdir().unwrap();
    for (options, expected) in [
        ("", "<FILE>..."),
        ("--every 0 r.mcap", "0 is not in 1.."),
        ("--headings 12 r.mcap", "a multiple of 8"),
    ] {
        let arguments = format!("evaluate {options}");
        assert_refused(folder.path(), &arguments, 2, expected);
    }
    let no_map = "evaluate --map none.yaml a.mcap b.mcap";
    assert_names(folder.path(), no_map, "none.yaml");
}

fn real(bag: &Path, options: &str) -> Value {
    let arguments = format!("evaluate --json {options} {}", bag.display());
    parsed(&output(Path::new("."), &arguments)).remove(0)
}

fn share(object: &Value, key: &str) -> f64 {
    object[key].as_f64().unwrap()
}

#[test]
fn the_answers_of_another_program_are_judged_as_ours() {
    let folder = tempfile::tempdir().unwrap();
    let bag = recordings().join("malaga_corridor/recording.mcap");
    let out = folder.path().display();
    let ours = real(&bag, &format!("--sequence --starts 1 --trajectories {out}"));
    let written = |name: &str| format!("--answers {out}/{name} --answers-of laser");
    let of_tracker = real(&bag, &written("recording.tum"));
    let errors = (&of_tracker["trajectory"], &ours["from_first_scan"]);
    assert_eq!(errors.0["poses"], errors.1["poses"]);
    for error in ["ape_m", "rpe_m", "rpe_deg"] {
        let [found, expected] = [errors.0, errors.1].map(|all| share(&all[error], "rmse"));
        // Quaternions are rounded.
        assert!((found - expected).abs() < 1e-9, "{error}: {errors:?}");
    }
    let answered = share(&of_tracker, "answered");
    assert_eq!(answered, share(&ours["from_first_scan"], "poses"));
    assert!(answered < 37.0, "the first scans have no pose: {ours}");
    assert_eq!(share(&of_tracker, "success_50cm_10deg"), answered / 37.0);
    assert_eq!(of_tracker["wrong_scans"], 0, "{of_tracker}");
    let truth = real(&bag, &written("recording_truth.tum"));
    assert_eq!(share(&truth, "success_50cm_10deg"), 1.0, "{truth}");
    assert!(share(&truth["trajectory"]["ape_m"], "max") < 1e-9);
}

#[test]
fn answers_of_the_base_are_carried_to_the_laser() {
    let folder = folder();
    let pose = |second: i64, place| {
        let base = map_from_laser(place).then(BASE_FROM_LASER.inverse());
        let stamp_ns = second * SECOND_NS;
        let Pose { x, y, yaw } = base;
        format!(
            "{{\"stamp_ns\":{stamp_ns},\"x\":{x},\"y\":{y},\"yaw\":{yaw},\"probability\":0.9}}\n"
        )
    };
    let messages = [
        map_message(),
        mount_message(),
        scan_at(1, HERE),
        truth_at(1, HERE),
        scan_at(3, HERE),
        truth_at(3, HERE),
        scan_at(4, THERE),
        truth_at(4, THERE),
    ];
    record(&folder.path().join("m.mcap"), &messages);
    let file = folder.path().join("a.json");
    fs::write(&file, pose(1, HERE) + &pose(4, HERE)).unwrap();
    let evaluate = |options: &str| run(folder.path(), &format!("evaluate --answers {options}"));
    let (code, stdout, stderr) = evaluate("a.json --json m.mcap");
    assert_eq!(code, 0, "{stderr}");
    tests::schemas::assert_follows("evaluate_answers", stdout.trim_end());
    let object = &parsed(&stdout)[0];
    assert_eq!(counts(object, ["answered", "truths"]), [2, 3]);
    assert_eq!(share(object, "success_50cm_10deg"), 1.0 / 3.0, "{object}");
    assert_eq!(counts(object, ["unique_wrong", "wrong_scans"]), [1, 1]);
    assert!(share(&object["error_m"], "median") < 1e-9, "{object}");
    let judged = evaluate("a.json --answer-gap-s 3 --max-wrong 0 m.mcap");
    for line in [
        "truths 3, with an answer 3 of the 2",
        "within 0.5 m and 10° 66.7 %",
        "0.80..0.90",
    ] {
        assert!(judged.1.contains(line), "{line}: {}", judged.1);
    }
    let missed = "m.mcap: Unique and wrong are 1, --max-wrong 0";
    assert_ends(judged, 1, missed);
    fs::write(&file, pose(7, HERE)).unwrap();
    let no_stamp = "no pose, from 7.000 to 7.000 s, has the stamp";
    let several = "--answers are those to one recording; 2 are given";
    for (options, code, expected) in [
        ("a.json m.mcap", 1, no_stamp),
        ("none.json m.mcap", 1, "cannot read none.json"),
        ("m.mcap m.mcap", 1, "cannot read m.mcap"),
        ("a.json m.mcap m.mcap", 2, several),
    ] {
        assert_ends(evaluate(options), code, expected);
    }
}

#[test]
fn options_that_mean_nothing_beside_answers_are_refused() {
    let options = "--sequence, --starts 3, --ignore-truth 3, --map map.yaml, --map-topic /map, \
                   --odom-topic /odom, --erase-place 2.5, --max-p90-ms 40, --max-losses 0, \
                   --heading-from odometry, --scan-stamp last, --headings 360, --threads 2, \
                   --robot-radius 1, --sigma-m 0.1, --candidates 64, --unique-from 0.9, \
                   --fit-sigma-m 0.1, --index-cache here, --sure 0.94";
    for option in options.split(", ") {
        let command = format!("evaluate --answers a.json {option} m.mcap");
        let (code, _, stderr) = run(Path::new("."), &command);
        let is_refused = stderr.contains("cannot be used with") && stderr.contains("--answers");
        assert!(code == 2 && is_refused, "{option}: {stderr}");
    }
}
