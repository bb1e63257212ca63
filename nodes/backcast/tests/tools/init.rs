//! Tests of `backcast init` and `check`.

use std::fs;

use crate::drawn::{assert_refused, recordings, run};

/// Returns the command line with the corridor's files in place of `DRIVE` and `MAP`.
fn init(options: &str) -> String {
    let corridor = recordings().join("malaga_corridor");
    let corridor = corridor.display();
    let options = options.replace("DRIVE", &format!("{corridor}/recording.mcap"));
    format!(
        "init {}",
        options.replace("MAP", &format!("{corridor}/map.yaml"))
    )
}

#[test]
fn a_descriptor_is_written_for_each_kind_of_source_and_is_sound() {
    // Built by the test run, next to the command.
    let _ = tests::executables::path("backcast");
    let folder = tempfile::tempdir().unwrap();
    for (file, options) in [
        (
            "laser.yaml",
            "--laser 192.168.0.1 --no-probe --map MAP --mount 0.2,0,-90",
        ),
        ("serial.yaml", "--serial /dev/ttyUSB7 --no-probe --map MAP"),
        ("replay.yaml", "--replay DRIVE --map MAP"),
        ("own_map.yaml", "--replay DRIVE"),
    ] {
        let done = |arguments: &str, part: &str| {
            let (code, stdout, stderr) = run(folder.path(), arguments);
            assert!(code == 0 && stdout.contains(part), "{stdout}{stderr}");
        };
        let written = format!("backcast run {file}");
        done(&init(&format!("{options} --out {file}")), &written);
        done(&format!("check {file}"), &format!("{file} is sound\n\n"));
    }
    let text = fs::read_to_string(folder.path().join("laser.yaml")).unwrap();
    let args = "--tcp 192.168.0.1:2112 --protocol cola-b --mount 0.2,0,-90";
    assert!(text.contains(args), "{text}");

    let again = init("--replay DRIVE --map MAP --out replay.yaml");
    assert_refused(folder.path(), &again, 2, "--force");
    assert_eq!(run(folder.path(), &format!("{again} --force")).0, 0);
}

#[test]
fn what_cannot_be_meant_leaves_no_file() {
    let folder = tempfile::tempdir().unwrap();
    for (options, code, said) in [
        ("--map MAP", 2, "--laser"),
        ("--laser a --ros2 --map MAP", 2, "cannot be used with"),
        ("--laser 127.0.0.1:9 --map MAP", 1, "--no-probe"),
        ("--serial /dev/no-such --map MAP", 1, "/dev/no-such"),
        ("--replay MAP --map MAP", 1, "map.yaml"),
        ("--replay DRIVE --map DRIVE", 2, "is a recording"),
        ("--replay DRIVE --map nowhere.yaml", 1, "nowhere.yaml"),
        ("--laser a", 2, "--map is missing"),
        ("--laser a", 2, "or --maps, a folder of several"),
        ("--laser a --map nowhere.yaml", 1, "nowhere.yaml"),
        ("--ros2 --mount 780,0,0", 2, "within 10 metres"),
        ("--replay DRIVE --map MAP --mount 1,2,3", 2, "/tf_static"),
        ("--ros2 --mount 1,2", 2, "X,Y,YAW_DEG"),
    ] {
        assert_refused(folder.path(), &init(options), code, said);
        assert!(!folder.path().join("dataflow.yaml").exists(), "{options}");
    }
}

#[test]
fn arguments_that_a_node_does_not_take_are_named() {
    let _ = tests::executables::path("backcast");
    let folder = tempfile::tempdir().unwrap();
    let nodes = "nodes:
  - {id: m, path: map_server, outputs: [map], args: --mapp x}
  - {id: t, path: tracker}
  - {id: w, path: tracker, args: --remember}
  - {id: b, path: other/tracker, build: none}
";
    fs::write(folder.path().join("g.yaml"), nodes).unwrap();
    let (code, stdout, stderr) = run(folder.path(), "check g.yaml");
    assert_eq!((code, stdout.as_str()), (1, ""), "{stderr}");
    for part in ["g.yaml: node m: unexpected argument '--mapp'", "\nnode w: "] {
        assert!(stderr.contains(part), "{stderr}");
    }
    assert!(!stderr.contains("node t"), "{stderr}");
    let map = recordings().join("malaga_corridor/map.yaml");
    let fewer = nodes
        .replace("--mapp x", &format!("--map {}", map.display()))
        .replace(", args: --remember", "");
    fs::write(folder.path().join("g.yaml"), fewer).unwrap();
    let (code, stdout, stderr) = run(folder.path(), "check g.yaml");
    assert_eq!(code, 1, "{stderr}");
    assert!(stderr.contains("not built: arguments of b"), "{stderr}");
    assert!(stdout.starts_with("m ("), "{stdout}");
}
