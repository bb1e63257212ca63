//! The repository's graph under faults: docs/reliability.md names these tests. A fault lasts for a
//! fixed time; the recovery is waited for without a limit.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::collections::BTreeSet;
use std::thread::sleep;
use std::time::Duration;

use messages::{HealthHeader, NodeState, topic};
use nix::sys::signal::{Signal, kill};
use recording::{Message, Recording};
use tests::live::{Live, files_of};
use tests::needs::has_its_own;
use transport::testing::wait_for_health;
use transport::{Graph, GraphName, monotonic_ns};

fn name(tag: &str) -> String {
    format!("r{}-{tag}", std::process::id())
}

/// Stops the graph in order, checks that no pose was wrong, and returns the log.
fn stop(live: Live) -> Vec<String> {
    let (status, summary, said) = live.stop();
    assert!(status.success(), "{status}: {said:#?}");
    assert_eq!(summary["pose"]["unique_wrong"], 0, "{summary}");
    said
}

#[test]
fn a_node_that_hangs_is_ended_and_started_again() {
    let mut live = Live::start(&name("hang"), "    health_check_timeout: 2\n");
    live.poses(3);
    for executable in ["accumulator", "tracker"] {
        let hung = live.node(executable);
        kill(hung, Signal::SIGSTOP).unwrap();
        while live.node(executable) == hung {
            sleep(Duration::from_millis(20));
        }
        // Poses that were in progress may be among them.
        live.poses(20);
    }
    let said = stop(live).join("\n");
    for executable in ["accumulator", "tracker"] {
        let expected = format!("{executable} sent no heartbeat for");
        assert!(said.contains(&expected), "{said}");
    }
}

#[test]
fn nodes_that_are_killed_again_and_again_end_nothing_and_leave_nothing() {
    let name = name("kills");
    let mut live = Live::start(&name, "");
    live.poses(3);
    let nodes = [
        "tracker",
        "accumulator",
        "map_server",
        "peak_extractor",
        "boundary_extractor",
    ];
    // First every node alone, then each with its neighbour.
    for round in 0..2 {
        for (i, executable) in nodes.iter().enumerate() {
            let mut pids = vec![live.node(executable)];
            if round == 1 {
                pids.push(live.node(nodes[(i + 1) % nodes.len()]));
            }
            for pid in pids {
                kill(pid, Signal::SIGKILL).unwrap();
            }
            live.poses(6);
        }
    }
    stop(live);
    assert_eq!(files_of(&name), [""; 0]);
}

#[test]
fn a_graph_that_was_killed_as_a_whole_is_cleaned_up_by_the_next() {
    let (killed, next) = (name("killed"), name("next"));
    let mut live = Live::start(&killed, "");
    live.poses(2);
    live.kill_all();
    assert!(files_of(&killed).len() > 50, "{:#?}", files_of(&killed));
    let mut live = Live::start(&next, "");
    live.poses(1);
    assert_eq!(files_of(&killed), [""; 0]);
    let (status, ..) = live.stop();
    assert!(status.success(), "{status}");
    assert_eq!(files_of(&next), [""; 0]);
}

#[test]
fn a_launcher_that_is_killed_is_started_again_under_the_same_name() {
    let name = name("again");
    for _ in 0..5 {
        let mut live = Live::start(&name, "");
        live.poses(2);
        kill(live.launcher(), Signal::SIGKILL).unwrap();
        // The test does not wait for the end of these nodes: the next graph does so itself.
    }
    let mut live = Live::start(&name, "");
    live.poses(2);
    let (status, ..) = live.stop();
    assert!(status.success(), "{status}");
    assert_eq!(files_of(&name), [""; 0]);
}

#[test]
fn full_shared_memory_ends_nothing_and_is_reported() {
    let test = "full_shared_memory_ends_nothing_and_is_reported";
    if !has_its_own(test, "/dev/shm", "96m") {
        return;
    }
    let name = name("full");
    let mut live = Live::start(&name, "");
    live.poses(5);
    let before = live.nodes();
    fill("/dev/shm/filler");
    sleep(Duration::from_secs(1));
    let member = GraphName::new(&name).unwrap();
    std::fs::remove_file("/dev/shm/filler").unwrap();
    let graph = Graph::join_named("test", &member).unwrap();
    let health = graph.subscriber::<topic::Health>().unwrap();
    let (_, error) = wait_for_health(&graph, &health, |report| {
        report.node.as_str() == "replayer" && report.dropped > 0
    });
    assert!(error.contains("shared memory is full"), "{error}");
    drop((health, graph));
    live.poses(10);
    assert_eq!(live.nodes(), before, "no process was started anew");
    stop(live);
}

#[test]
fn a_disk_that_is_full_for_a_while_delays_no_pose_and_spoils_no_recording() {
    let test = "a_disk_that_is_full_for_a_while_delays_no_pose_and_spoils_no_recording";
    if !has_its_own(test, "/mnt", "16m") {
        return;
    }
    let name = name("disk");
    let mut live = Live::start_with(&name, "", &["--record", "/mnt/drive.mcap"]);
    live.poses(5);
    let before = live.nodes();
    let graph = Graph::join_named("test", &GraphName::new(&name).unwrap()).unwrap();
    let health = graph.subscriber::<topic::Health>().unwrap();
    fill("/mnt/filler");
    let is_recorder = |report: &HealthHeader| report.node.as_str() == "recorder";
    let (_, error) = wait_for_health(&graph, &health, |report| {
        is_recorder(report) && report.state == NodeState::Degraded as u32
    });
    assert!(error.contains("No space left on device"), "{error}");
    let missed = live.poses(20);
    std::fs::remove_file("/mnt/filler").unwrap();
    wait_for_health(&graph, &health, |report| {
        is_recorder(report) && report.state == NodeState::Ready as u32
    });
    drop((health, graph));
    let later = live.poses(20);
    assert_eq!(live.nodes(), before, "no process was started anew");
    stop(live);
    // Messages that came while the disk was full waited in memory.
    let recording = Recording::open("/mnt/drive.mcap").unwrap();
    assert!(recording.damage_error().is_none(), "it has been ended");
    let scans = recording.records().map(Result::unwrap);
    let stamps = scans.filter_map(|record| match record.message {
        Message::Scan(scan) => Some(scan.header.stamp.as_ns()),
        _ => None,
    });
    let recorded: BTreeSet<i64> = stamps.collect();
    for stamp in [missed, later].concat() {
        assert!(recorded.contains(&stamp), "{stamp} of {recorded:?}");
    }
}

#[test]
fn a_node_that_stands_still_for_ten_seconds_goes_on_where_the_others_are() {
    let mut live = Live::start(&name("still"), "");
    live.poses(3);
    for executable in ["accumulator", "peak_extractor", "tracker"] {
        let stopped = live.node(executable);
        kill(stopped, Signal::SIGSTOP).unwrap();
        sleep(Duration::from_secs(10));
        kill(stopped, Signal::SIGCONT).unwrap();
        let goes_on = monotonic_ns();
        // Poses that waited for it come first.
        while live.pose()["sent_ns"].as_i64().unwrap() < goes_on {}
        assert_eq!(live.node(executable), stopped, "it was not started anew");
    }
    stop(live);
}

/// Writes until the file system is full.
fn fill(path: &str) {
    let mut file = std::fs::File::create(path).unwrap();
    for size in [1 << 16, 1] {
        while std::io::Write::write_all(&mut file, &vec![0; size]).is_ok() {}
    }
}
