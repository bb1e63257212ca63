//! Ends of nodes and their effect on the run.

use super::*;

#[test]
fn a_run_ends_with_its_source_and_stops_the_rest() {
    let (code, stdout, stderr) = run(
        &[
            "id: source, outputs: [scan], args: \"-c 'echo out; echo err >&2'\"",
            "id: server, outputs: [map], args: \"-c 'exec sleep 1000'\"",
        ],
        &[],
    );
    assert_eq!(code, 0, "{stderr}");
    assert!(stderr.contains(" source | out\n"), "{stderr}");
    assert!(stderr.contains(" source | err\n"), "{stderr}");
    assert!(stdout.contains("scans      0, answered 0"), "{stdout}");
}

#[test]
fn nodes_find_their_folder_graph_and_environment() {
    let folder = graph(&[
        "id: a, env: {TAG: 7}, args: \"-c 'echo $0 $TAG $BACKCAST_GRAPH; pwd -P' 'two words'\"",
    ]);
    let mut running = Running::start(&folder, &["run", "./dataflow.yaml", "--graph", "test-env"]);
    assert_eq!(running.receive("a"), "two words 7 test-env");
    let expected = folder.path().canonicalize().unwrap();
    assert_eq!(running.receive("a"), expected.to_str().unwrap());
    running.end_well();
}

#[test]
fn a_node_that_fails_for_good_ends_the_run_and_is_named() {
    let (code, stdout, stderr) = run(
        &[
            "id: bad, restart_policy: on-failure, max_restarts: 2, args: \"-c 'echo up; exit 7'\"",
            "id: good, args: \"-c 'exec sleep 1000'\"",
        ],
        &[],
    );
    assert_eq!(code, 1, "{stderr}");
    assert_eq!(stderr.matches(" bad | up\n").count(), 3, "{stderr}");
    let named = "node bad ended with exit status: 7 after 2 restarts in short time";
    assert!(stderr.contains(named), "{stderr}");
    assert!(!stdout.contains("scans"), "{stdout}");
}

/// Waits until the launcher of a graph reports that it is degraded, for a reason with this part.
fn wait_until_degraded(graph: &str, reason: &str) {
    let member = Graph::join_named("tester", &GraphName::new(graph).unwrap()).unwrap();
    let health = member.subscriber::<topic::Health>().unwrap();
    wait_until(&member, &health, |report, error| {
        report.node.as_str() == "backcast"
            && report.state == NodeState::Degraded as u32
            && String::from_utf8_lossy(error).contains(reason)
    });
}

#[test]
fn a_node_that_fails_each_time_is_shown_with_its_reason() {
    let name = "test-fails";
    let folder = graph(&[
        "id: loops, restart_policy: on-failure, restart_delay: 0.1, max_restart_delay: 0.3, \
         args: \"-c 'echo it broke >&2; echo http://robot/#token=1 >&2; exit 7'\"",
        "id: source, outputs: [scan], args: \"-c 'exec sleep 1000'\"",
    ]);
    let mut running = Running::start(&folder, &["--graph", name]);
    let shown = "loops ended 3 times in a row, last with exit status: 7: it broke";
    while running.receive("backcast") != shown {}
    wait_until_degraded(name, "times in a row, last with exit status: 7");
    let (_, status, _) = said_by(&mut launcher(folder.path(), &["status", "--graph", name]));
    assert!(status.contains("\n  loops ended "), "{status}");
    running.signal(Signal::SIGTERM);
    running.end_well();
}

#[test]
fn a_node_that_only_shows_fails_for_good_and_the_rest_goes_on() {
    let name = "test-goes-on";
    let folder = graph(&[
        "id: shown, env: {BACKCAST_ESSENTIAL: false}, restart_policy: on-failure, max_restarts: 1, \
         args: \"-c 'echo up; exit 7'\"",
        "id: source, outputs: [scan], args: -c 'read line < pipe'",
    ]);
    mkfifo(&folder.path().join("pipe"), Mode::S_IRWXU).unwrap();
    let mut running = Running::start(&folder, &["--graph", name]);
    let goes_on = "node shown ended with exit status: 7 after 1 restart in short time; see its last \
                   log lines; the graph continues without shown";
    while running.receive("backcast") != goes_on {}

    // Processes that ask later receive the state as well.
    wait_until_degraded(name, "the graph continues without shown");

    let_go(&folder);
    running.end_well();
}

#[test]
fn a_signal_stops_even_what_does_not_want_to() {
    let folder = graph(&[
        "id: polite, args: \"-c 'echo $$; exec sleep 1000'\"",
        "id: stubborn, args: \"-c 'trap : TERM; echo $$; while :; do sleep 1000; done'\"",
        "id: parent, args: \"-c 'sleep 1000 & echo $!; wait'\"",
    ]);
    for signal in [Signal::SIGINT, Signal::SIGTERM] {
        let mut running = Running::start(&folder, &["--graph", "test-stop"]);
        // The output of different nodes has no fixed order.
        let mut pids = Vec::new();
        while pids.len() < 3 {
            let line = running.said.next().unwrap().unwrap();
            let (who, what) = line.split_once(" | ").unwrap_or(("", ""));
            if who.trim() != "backcast" && what.parse::<i32>().is_ok() {
                pids.push(what.to_owned());
            }
        }
        running.signal(signal);
        running.end_well();
        for pid in &pids {
            assert!(has_ended(pid), "{pid} of {pids:?}");
        }
        assert_eq!(shared_memory_of("test-stop"), [""; 0]);
    }
}

#[test]
fn a_killed_launcher_leaves_no_orphans() {
    let folder = graph(&["id: a, args: \"-c 'exec 3> pipe; echo up; exec sleep 1000'\""]);
    let pipe = folder.path().join("pipe");
    mkfifo(&pipe, Mode::S_IRWXU).unwrap();
    let mut running = Running::start(&folder, &["--graph", "test-kill"]);
    // Opening waits until the node opens its end; reading waits until the node ends.
    let mut reader = File::open(&pipe).unwrap();
    assert_eq!(running.receive("a"), "up");
    running.signal(Signal::SIGKILL);
    let mut rest = String::new();
    reader.read_to_string(&mut rest).unwrap();
    let (status, _) = running.wait();
    assert_eq!(status.signal(), Some(9));
    transport::remove_leftovers(&GraphName::new("test-kill").unwrap()).unwrap();
}
