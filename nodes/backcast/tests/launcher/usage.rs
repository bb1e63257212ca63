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
    let executable = std::os::unix::fs::PermissionsExt::from_mode(0o755);
    fs::set_permissions(folder.path().join("x"), executable).unwrap();
    let (code, _, said) = said_by(&mut launcher(folder.path(), &[]));
    assert_eq!(code, 1, "{said}");
    let is_named = said.contains("node a: ") && said.contains("cannot be started in");
    assert!(is_named, "{said}");
}

#[test]
fn wrong_use_and_wrong_graphs_have_their_exit_codes() {
    let empty = tempfile::tempdir().unwrap();
    let nowhere = said_by(&mut launcher(empty.path(), &[]));
    assert_ends(nowhere, 2, "there is no file dataflow.yaml in");
    let twice = run(&["id: a", "id: a"], &[]);
    assert_ends(twice, 1, "dataflow.yaml:3:25: a second node");
}

#[test]
fn check_starts_nothing() {
    let (code, stdout, stderr) = run(
        &["id: a, outputs: [scan], args: -c 'echo started'"],
        &["check"],
    );
    assert_eq!(code, 0, "{stderr}");
    assert!(stdout.starts_with("dataflow.yaml is sound\n"), "{stdout}");
    assert!(!stderr.contains("started"), "{stderr}");
}
