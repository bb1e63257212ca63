//! Errors in options and descriptors.

use super::*;

#[test]
fn wrong_options_of_a_node_are_not_tried_again() {
    let (code, _, stderr) = run(
        &["id: bad, restart_policy: on-failure, args: \"-c 'echo up; exit 2'\""],
        &[],
    );
    assert_eq!(code, 1, "{stderr}");
    assert_eq!(stderr.matches(" bad | up\n").count(), 1, "{stderr}");
}

#[test]
fn an_executable_that_does_not_start_is_named() {
    let folder = graph(&["id: a, args: \"-c 'exec sleep 1000'\""]);
    let text = "nodes: [{id: a, path: ./x}]";
    fs::write(folder.path().join("dataflow.yaml"), text).unwrap();
    fs::write(folder.path().join("x"), "#!/no/such/interpreter\n").unwrap();
    Command::new("chmod")
        .arg("+x")
        .arg(folder.path().join("x"))
        .status()
        .unwrap();
    let output = launcher(folder.path(), &[]).output().unwrap();
    assert_eq!(output.status.code(), Some(1));
    let said = String::from_utf8(output.stderr).unwrap();
    assert!(
        said.contains("node a: ") && said.contains("cannot be started in"),
        "{said}"
    );
}

#[test]
fn wrong_use_and_wrong_graphs_have_their_exit_codes() {
    let empty = tempfile::tempdir().unwrap();
    let missing = launcher(empty.path(), &[]).output().unwrap();
    assert_eq!(missing.status.code(), Some(2));
    let said = String::from_utf8(missing.stderr).unwrap();
    assert!(said.contains("there is no file dataflow.yaml in"), "{said}");

    let (code, _, said) = run(&["id: a"], &["--rate", "max"]);
    assert_eq!(code, 2, "{said}");
    assert!(
        said.contains("--rate is for the replayer or emulator"),
        "{said}"
    );

    let (code, _, said) = run(&["id: a", "id: a"], &[]);
    assert_eq!(code, 1, "{said}");
    assert!(said.contains("dataflow.yaml:3:25: a second node"), "{said}");
}

#[test]
fn check_starts_nothing() {
    let (code, stdout, stderr) = run(
        &["id: a, outputs: [scan], args: -c 'echo started'"],
        &["check"],
    );
    assert_eq!(code, 0, "{stderr}");
    assert!(
        stdout.starts_with("dataflow.yaml is sound\n\na (/bin/sh)\n"),
        "{stdout}"
    );
    assert!(!stderr.contains("started"), "{stderr}");
    let (code, stdout, stderr) = run(&["id: a, outputs: [scam]"], &["check"]);
    assert_eq!((code, stdout.as_str()), (1, ""));
    assert!(stderr.contains("there is no topic `scam`"), "{stderr}");
}
