//! Graphs and their names: occupied names, access rights, and control from other processes.

use std::os::unix::fs::PermissionsExt;

use tests::schemas::assert_follows;

use super::*;

/// Returns true if the test may start processes of other users; otherwise counts it as skipped.
fn may_act_as_others(test: &str) -> bool {
    let is_root = nix::unistd::geteuid().is_root();
    if !is_root {
        Need::Root.is_missing(test, "nobody else can act as two users");
    }
    is_root
}

fn give(folder: &Path, user: u32) {
    nix::unistd::chown(folder, Some(nix::unistd::Uid::from_raw(user)), None).unwrap();
}

#[test]
fn a_name_that_is_alive_is_refused_and_goes_on() {
    let name = "test-alive";
    let folder = waiting_graph();
    let running = Running::start_and_wait(&folder, name);
    let other = run(&["id: a, args: -c true"], &["--graph", name]);
    assert_ends(other, 1, "graph test-alive still runs");
    assert!(!shared_memory_of(name).is_empty());
    let_go(&folder);
    running.end_well();
    assert_eq!(shared_memory_of(name), [""; 0]);
}

#[test]
fn a_name_that_another_user_has_taken_is_refused_and_the_user_named() {
    if !may_act_as_others("a_name_that_another_user_has_taken_is_refused_and_the_user_named") {
        return;
    }
    let file = Path::new("/dev/shm/bc12345_test-foreign.in_the_way");
    fs::write(file, "").unwrap();
    let folder = graph(&["id: a, args: -c true"]);
    give(folder.path(), 12_345);
    let (code, _, said) =
        said_by(launcher(folder.path(), &["--graph", "test-foreign"]).uid(12_345));
    fs::remove_file(file).unwrap();
    assert_eq!(code, 1, "{said}");
    assert!(said.contains("in_the_way belongs to user 0"), "{said}");
    assert!(said.contains("--graph"), "{said}");
}

/// A folder in `/tmp` of another user does not keep a graph from starting.
#[test]
fn a_folder_that_another_user_has_taken_is_passed_over() {
    if !may_act_as_others("a_folder_that_another_user_has_taken_is_passed_over") {
        return;
    }
    let user = 12_346;
    let taken = format!("/tmp/backcast-{user}");
    fs::create_dir(&taken).unwrap();
    let folder = graph(&["id: a, args: -c true"]);
    let own = tempfile::tempdir_in("/tmp").unwrap();
    for path in [folder.path(), own.path()] {
        give(path, user);
    }
    fs::set_permissions(own.path(), PermissionsExt::from_mode(0o700)).unwrap();
    let [passed, refused] = [own.path(), Path::new("/nowhere")].map(|own| {
        let mut launcher = launcher(folder.path(), &["--graph", "test-taken"]);
        said_by(launcher.env("XDG_RUNTIME_DIR", own).uid(user))
    });
    fs::remove_dir(taken).unwrap();
    assert_eq!(passed.0, 0, "{}", passed.2);
    assert!(own.path().join("backcast").is_dir());
    assert_eq!(refused.0, 1, "{}", refused.2);
    assert!(refused.2.contains("belongs to user 0"), "{}", refused.2);
}

#[test]
fn a_graph_of_another_user_is_named_with_the_way_to_it() {
    if !may_act_as_others("a_graph_of_another_user_is_named_with_the_way_to_it") {
        return;
    }
    let folder = graph(&["id: source, outputs: [scan], args: \"-c 'echo up; exec sleep 1000'\""]);
    let user = 12_347;
    give(folder.path(), user);
    let running = Running::start_and_wait(&folder, "test-seen");
    let status = said_by(launcher(folder.path(), &["status"]).uid(user));
    running.signal(Signal::SIGTERM);
    running.end_well();
    let way = "user root runs graph test-seen: `sudo -u root backcast status`";
    assert_ends(status, 1, way);
}

#[test]
fn others_have_no_rights_on_the_files_of_a_graph() {
    let name = "test-rights";
    let folder = waiting_graph();
    let running = Running::start_and_wait(&folder, name);
    let files = shared_memory_of(name);
    assert!(files.len() > 3, "{files:?}");
    for file in files {
        let found = fs::metadata(Path::new("/dev/shm").join(&file)).unwrap();
        let mode = found.permissions().mode();
        assert_eq!(mode & 0o077, 0, "{file}: {mode:o}");
    }
    running.signal(Signal::SIGHUP);
    running.end_well();
}

#[test]
fn a_graph_whose_files_are_removed_is_started_again_as_a_whole() {
    let name = "test-cleaned";
    let folder = waiting_graph();
    let mut running = Running::start_and_wait(&folder, name);
    let socket = transport::control_socket(&transport::GraphName::new(name).unwrap());
    remove_files_of(socket.parent().unwrap(), &format!("_{name}."));
    assert_eq!(running.receive("source"), "up", "a second time");
    let_go(&folder);
    running.end_well();
    assert_eq!(shared_memory_of(name), [""; 0]);
}

/// Removes the files whose path contains `part`, as a cleaner of temporary folders does.
fn remove_files_of(folder: &Path, part: &str) {
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        let path = entry.path();
        if path.is_dir() {
            remove_files_of(&path, part);
        } else if path.to_string_lossy().contains(part) {
            fs::remove_file(&path).unwrap();
        }
    }
}

#[test]
fn a_graph_is_asked_restarted_in_part_and_stopped_from_elsewhere() {
    let name = "test-control";
    let folder = graph(&[
        "id: source, outputs: [scan], args: \"-c 'echo up; exec sleep 1000'\"",
        "id: other, args: \"-c 'trap : TERM; while true; do sleep 0.1; done'\"",
    ]);
    let mut running = Running::start_and_wait(&folder, name);
    let ask = |args: &str| {
        let args = format!("{args} --graph {name}");
        let args: Vec<&str> = args.split(' ').collect();
        said_by(&mut launcher(folder.path(), &args))
    };
    let done = |args: &str| {
        let (code, stdout, said) = ask(args);
        assert_eq!(code, 0, "{args}: {said}");
        stdout
    };
    let stdout = done("status --json");
    assert_follows("status", &stdout);
    let status: serde_json::Value = serde_json::from_str(&stdout).unwrap();
    assert_eq!(
        (&status["graph"], &status["nodes"][0]["state"]),
        (&name.into(), &"running".into())
    );
    let before = status["nodes"][0]["pid"].clone();

    let unknown = "no node sauce: allowed are source";
    assert_ends(ask("restart sauce"), 2, unknown);
    done("restart source");
    assert_eq!(running.receive("source"), "up", "a second time");
    let status: serde_json::Value = serde_json::from_str(&done("status --json")).unwrap();
    assert_ne!(status["nodes"][0]["pid"], before);
    assert_eq!(status["nodes"][0]["restarts"], 1);
    assert!(done("status").contains("source               running"));

    assert_ends(ask("record start"), 2, "there is no /bin/recorder");
    assert_ends(ask("record stop"), 2, "nothing is being recorded");

    let stdout = done("logs backcast");
    assert!(stdout.contains("source is restarted from"), "{stdout}");
    let stdout = done("logs --json");
    assert!(stdout.contains("restarted"), "{stdout}");
    stdout.lines().for_each(|line| assert_follows("logs", line));

    let mut follower = launcher(folder.path(), &["logs", "--follow", "--graph", name])
        .spawn()
        .unwrap();
    let mut lines = BufReader::new(follower.stdout.take().unwrap());
    let mut first = String::new();
    lines.read_line(&mut first).unwrap();
    assert!(first.contains("backcast | "), "{first}");

    done("stop");
    let graph = GraphName::new(name).unwrap();
    assert!(!transport::is_launched(&graph), "its name is free at once");
    running.end_well();
    std::io::copy(&mut lines, &mut std::io::sink()).unwrap();
    let followed = follower.wait_with_output().unwrap();
    let said = String::from_utf8(followed.stderr).unwrap();
    assert_eq!(followed.status.code(), Some(0), "{said}");
    assert!(said.contains("graph test-control has ended"), "{said}");
    assert_ends(ask("stop"), 1, "no launcher of graph test-control");
}

#[test]
fn a_service_manager_is_notified_that_the_graph_runs_and_stops() {
    let folder = graph(&["id: source, outputs: [scan], args: \"-c 'exec sleep 1000'\""]);
    let path = folder.path().join("notify");
    let socket = UnixDatagram::bind(&path).unwrap();
    let mut child = launcher(folder.path(), &["--graph", "test-notify"])
        .env("NOTIFY_SOCKET", &path)
        .spawn()
        .unwrap();
    let receive = || {
        let mut bytes = [0; 512];
        let length = socket.recv(&mut bytes).unwrap();
        String::from_utf8(bytes[..length].to_vec()).unwrap()
    };
    for _ in 0..2 {
        assert_eq!(receive(), "READY=1\nWATCHDOG=1\n");
    }
    kill(Pid::from_raw(child.id().cast_signed()), Signal::SIGTERM).unwrap();
    let last = std::iter::repeat_with(receive).find(|received| !received.contains("WATCHDOG"));
    assert_eq!(last.unwrap(), "STOPPING=1\n");
    assert!(child.wait().unwrap().success());
}
