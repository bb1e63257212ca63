//! Two graphs on one machine, started as users start them.

use std::path::Path;
use std::process::{Child, Stdio};

use serde_json::Value;
use tests::executables;

fn start(name: &str) -> Child {
    // Built first, so that the runs below do not have to build.
    let _ = executables::path("replayer");
    executables::backcast()
        .args(["run", "--rate", "max", "--json", "--graph", name])
        .current_dir(tests::root())
        .stdout(Stdio::piped())
        .spawn()
        .unwrap()
}

fn lines(graph: Child) -> Vec<Value> {
    let output = graph.wait_with_output().unwrap();
    assert!(output.status.success(), "{}", output.status);
    let text = String::from_utf8(output.stdout).unwrap();
    text.lines()
        .map(|line| serde_json::from_str(line).unwrap())
        .collect()
}

#[test]
fn two_graphs_do_not_receive_each_other() {
    let names = ["a", "b"].map(|tag| format!("s{}{tag}", std::process::id()));
    let [first, second] = [start(&names[0]), start(&names[1])];
    for lines in [lines(first), lines(second)] {
        // A pose for each of the 37 scans, each received once, and the summary.
        assert_eq!(lines.len(), 38);
        let stamps: Vec<i64> = lines[..37]
            .iter()
            .map(|line| line["stamp_ns"].as_i64().unwrap())
            .collect();
        assert!(
            stamps.is_sorted_by(|a, b| a < b),
            "each scan is answered once: {stamps:?}"
        );
    }
    for name in names {
        let left: Vec<_> = std::fs::read_dir(Path::new("/dev/shm"))
            .unwrap()
            .map(|entry| entry.unwrap().file_name().into_string().unwrap())
            .filter(|file| file.contains(&format!("_{name}.")))
            .collect();
        assert!(left.is_empty(), "left in shared memory: {left:?}");
    }
}
