//! The repository's graph under faults of all kinds: docs/reliability.md names this test.

use std::path::Path;
use std::process::{Command, Stdio};

use serde_json::{Value, json};
use tests::needs::has_its_own;

#[test]
fn a_graph_under_faults_meets_its_guarantees() {
    let test = "a_graph_under_faults_meets_its_guarantees";
    if !has_its_own(test, "/dev/shm", "256m") {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let descriptor = folder.path().join("dataflow.yaml");
    std::fs::write(&descriptor, tests::live::descriptor("")).unwrap();
    let program = Path::new(env!("CARGO_BIN_EXE_soak"));
    let output = Command::new(program)
        .arg(&descriptor)
        .env("XDG_CACHE_HOME", program.with_file_name("test-cache"))
        .args(["--minutes", "1.5", "--seed", "7"])
        .args(["--faults", "kill,pair,stop,map,launcher,tmp,shm"])
        .stderr(Stdio::inherit())
        .output()
        .unwrap();
    let report: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(report["failures"], json!([]), "{report}");
    assert_eq!(report["leftovers"], json!([]), "{report}");
    assert_eq!(report["wrong"], 0, "{report}");
    assert!(output.status.success(), "{report}");
    // A round holds seventeen faults, twelve of which kill nodes.
    let faults = report["faults"].as_array().unwrap();
    let killed = faults.iter().filter_map(|effect| effect["killed"].as_u64());
    assert!(killed.sum::<u64>() > 5, "{report}");
    assert!(report["judged"].as_u64() > Some(50), "{report}");
    assert!(report["answered"].as_u64() > Some(0), "{report}");
}
