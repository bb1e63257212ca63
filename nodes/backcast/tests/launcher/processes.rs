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
    assert!(stdout.contains("stamp s"), "{stdout}");
    assert!(stdout.contains("scans      0, answered 0"), "{stdout}");
}

#[test]
fn json_is_all_that_is_printed_with_json() {
    let (code, stdout, _) = run(&["id: source, outputs: [scan], args: -c true"], &["--json"]);
    assert_eq!(code, 0);
    let lines: Vec<serde_json::Value> = stdout
        .lines()
        .map(|l| serde_json::from_str(l).unwrap())
        .collect();
    assert_eq!(lines.len(), 1);
    assert_eq!(lines[0]["summary"]["scans"], 0);
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
    assert!(running.wait().0.success());
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
    let member = Graph::join_named("tester", &GraphName::new(name).unwrap()).unwrap();
    let health = member.subscriber::<topic::Health>().unwrap();
    wait_until(&member, &health, |report, error| {
        report.node.as_str() == "backcast"
            && report.state == NodeState::Degraded as u32
            && String::from_utf8_lossy(error).contains("times in a row, last with exit status: 7")
    });
    drop((health, member));
    let mut status = launcher(folder.path(), &["status", "--graph", name]);
    let status = String::from_utf8(status.output().unwrap().stdout).unwrap();
    assert!(status.contains("\n  loops ended "), "{status}");
    running.signal(Signal::SIGTERM);
    assert!(running.wait().0.success());
}

#[test]
fn a_signal_is_a_failure_like_any_other() {
    let (code, _, stderr) = run(&["id: bad, args: \"-c 'kill -KILL $$'\""], &[]);
    assert_eq!(code, 1);
    assert!(stderr.contains("node bad ended with signal: 9"), "{stderr}");
}

#[test]
fn a_node_that_only_shows_fails_for_good_and_the_rest_goes_on() {
    let name = "test-goes-on";
    let folder = graph(&[
        "id: shown, env: {BACKCAST_ESSENTIAL: false}, restart_policy: on-failure, max_restarts: 1, \
         args: \"-c 'echo up; exit 7'\"",
        "id: source, outputs: [scan], args: -c 'read line < pipe'",
    ]);
    let pipe = folder.path().join("pipe");
    mkfifo(&pipe, Mode::S_IRWXU).unwrap();
    let mut running = Running::start(&folder, &["--graph", name]);
    let lost = loop {
        let line = running.receive("backcast");
        if line.contains("continues without") {
            break line;
        }
    };
    assert!(
        lost.starts_with("node shown ended with exit status: 7 after 1 restart"),
        "{lost}"
    );

    // Processes that ask later receive the state as well.
    let member = Graph::join_named("tester", &GraphName::new(name).unwrap()).unwrap();
    let health = member.subscriber::<topic::Health>().unwrap();
    wait_for_health(&member, &health, |report| {
        report.node.as_str() == "backcast" && report.state == NodeState::Degraded as u32
    });
    drop((health, member));

    let mut writer = OpenOptions::new().write(true).open(&pipe).unwrap();
    std::io::Write::write_all(&mut writer, b"\n").unwrap();
    let (status, said) = running.wait();
    assert_eq!(status.code(), Some(0), "{said}");
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
        let (status, said) = running.wait();
        assert_eq!(status.code(), Some(0), "{said}");
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

/// Returns the stamp of scan `counter`, measured at `counter` milliseconds.
fn stamp(counter: u64) -> Stamp {
    Stamp {
        measured_ns: i64::try_from(counter).unwrap() * 1_000_000,
        entered_ns: transport::monotonic_ns(),
        counter,
    }
}

#[test]
fn answers_are_printed_and_summed_up() {
    let name = "test-answers";
    let folder = graph(&["id: source, outputs: [scan], args: -c 'read line < pipe'"]);
    let pipe = folder.path().join("pipe");
    mkfifo(&pipe, Mode::S_IRWXU).unwrap();
    let mut running = Running::start(&folder, &["--graph", name]);
    let mut printed = BufReader::new(running.child.stdout.take().unwrap()).lines();
    assert!(printed.next().unwrap().unwrap().contains("stamp s"));

    let member = Graph::join_named("tester", &GraphName::new(name).unwrap()).unwrap();
    let scans = member.publisher::<topic::Scan>().unwrap();
    let hypotheses = member.publisher::<topic::Hypotheses>().unwrap();
    let truths = member.publisher::<topic::GroundTruthTopic>().unwrap();
    for counter in 0..2 {
        let pose = Pose2 {
            x: 1.5,
            y: -2.0,
            yaw: 0.5,
        };
        let stamp = stamp(counter);
        let mut truth = truths.loan(0).unwrap();
        truth.header_mut().stamp = stamp;
        truth.header_mut().map_from_laser = pose;
        truth.send().unwrap();
        let mut scan = scans.loan(0).unwrap();
        scan.header_mut().stamp = stamp;
        scan.send().unwrap();
        let refused = counter == 1;
        let mut answer = hypotheses.loan(usize::from(!refused)).unwrap();
        *answer.header_mut() = HypothesesHeader {
            stamp,
            sent_ns: transport::monotonic_ns(),
            verdict: if refused {
                Verdict::NoScan
            } else {
                Verdict::Unique
            } as u32,
            ..bytemuck::Zeroable::zeroed()
        };
        if let Some(found) = answer.items_mut().first_mut() {
            *found = Hypothesis {
                map_from_laser: pose,
                ..bytemuck::Zeroable::zeroed()
            };
        }
        answer.send().unwrap();
        let line = printed.next().unwrap().unwrap();
        let expected = if refused {
            "0.001          -"
        } else {
            "0.000      1.500     -2.000        28.65"
        };
        assert!(line.trim_start().starts_with(expected), "{line}");
    }
    drop((scans, hypotheses, truths, member));

    // Writing ends the source and thereby the run.
    let mut writer = OpenOptions::new().write(true).open(&pipe).unwrap();
    std::io::Write::write_all(&mut writer, b"\n").unwrap();
    let rest: Vec<String> = printed.map(Result::unwrap).collect();
    let rest = rest.join("\n");
    assert!(rest.contains("scans      2, answered 2"), "{rest}");
    assert!(rest.contains("50.0 % within 0.5 m and 10 deg"), "{rest}");
    assert!(rest.contains("of 2 with known truth"), "{rest}");
    let (status, said) = running.wait();
    assert_eq!(status.code(), Some(0), "{said}");
    assert_eq!(shared_memory_of(name), [""; 0]);
}
