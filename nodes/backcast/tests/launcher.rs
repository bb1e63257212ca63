//! The launcher as a process, with small shell scripts as nodes. Tests wait for
//! what processes say or for the ends of pipes, never for time.

#![allow(
    clippy::unwrap_used,
    reason = "a test fails by panicking, helpers of tests too"
)]

use std::{
    fs::{self, File, OpenOptions},
    io::{BufRead, BufReader, Lines, Read},
    os::unix::net::UnixDatagram,
    os::unix::process::{CommandExt, ExitStatusExt},
    path::Path,
    process::{Child, ChildStderr, Command, ExitStatus, Output, Stdio},
};

use messages::{HypothesesHeader, Hypothesis, NodeState, Pose2, Stamp, Verdict, topic};
use nix::{
    sys::signal::{Signal, kill},
    sys::stat::Mode,
    unistd::{Pid, mkfifo},
};
use tempfile::TempDir;
use tests::needs::Need;
use transport::testing::wait_for_health;
use transport::{Graph, GraphName};

/// A folder with a descriptor of these nodes, one a line.
fn graph(nodes: &[&str]) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    let nodes: String = nodes
        .iter()
        .map(|n| format!("  - {{path: /bin/sh, {n}}}\n"))
        .collect();
    fs::write(
        folder.path().join("dataflow.yaml"),
        format!("nodes:\n{nodes}"),
    )
    .unwrap();
    folder
}

fn launcher(folder: &Path, args: &[&str]) -> Command {
    // Under nohup hangups are ignored, and the launcher leaves it at that.
    let mut command = Command::new("env");
    command
        .args(["--default-signal=HUP", env!("CARGO_BIN_EXE_backcast")])
        .args(args)
        .current_dir(folder)
        .env_remove("BACKCAST_GRAPH")
        .env_remove("RUST_LOG");
    command
        .stdin(Stdio::null())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped());
    command
}

/// Runs to the end: exit code, standard output, standard error.
fn run(nodes: &[&str], args: &[&str]) -> (i32, String, String) {
    let folder = graph(nodes);
    let Output {
        status,
        stdout,
        stderr,
    } = launcher(folder.path(), args).output().unwrap();
    let text = |bytes| String::from_utf8(bytes).unwrap();
    (status.code().unwrap(), text(stdout), text(stderr))
}

/// A launcher that runs, and what it says.
struct Running {
    child: Child,
    said: Lines<BufReader<ChildStderr>>,
}

impl Running {
    fn start(folder: &TempDir, args: &[&str]) -> Self {
        let mut child = launcher(folder.path(), args).spawn().unwrap();
        let said = BufReader::new(child.stderr.take().unwrap()).lines();
        Running { child, said }
    }

    /// Waits for `node` to say something and returns it.
    fn receive(&mut self, node: &str) -> String {
        let mark = format!("{node} | ");
        let all = self.said.by_ref().map(Result::unwrap);
        let mut received =
            all.filter_map(|line| line.trim_start().strip_prefix(&mark).map(ToOwned::to_owned));
        received
            .next()
            .unwrap_or_else(|| panic!("{node} said nothing more"))
    }

    fn signal(&self, signal: Signal) {
        let pid = i32::try_from(self.child.id()).unwrap();
        kill(Pid::from_raw(pid), signal).unwrap();
    }

    fn wait(mut self) -> (ExitStatus, String) {
        // Its pipe is read to the end, so that it does not wait for us.
        let said: Vec<String> = self.said.by_ref().map(Result::unwrap).collect();
        (self.child.wait().unwrap(), said.join("\n"))
    }
}

/// Whether a process has ended. One whose parent has ended before it stays a
/// zombie where nobody takes orphans, as in a container.
fn has_ended(pid: &str) -> bool {
    fs::read_to_string(format!("/proc/{pid}/stat")).map_or(true, |stat| stat.contains(") Z "))
}

fn shared_memory_of(graph: &str) -> Vec<String> {
    fs::read_dir("/dev/shm")
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .filter(|name| name.contains(graph))
        .collect()
}

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

    // Who asks later is stdout, too.
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
fn a_name_that_is_alive_is_refused_and_goes_on() {
    let name = "test-alive";
    let folder = graph(&["id: source, outputs: [scan], args: -c 'echo up; read line < pipe'"]);
    let pipe = folder.path().join("pipe");
    mkfifo(&pipe, Mode::S_IRWXU).unwrap();
    let mut running = Running::start(&folder, &["--graph", name]);
    assert_eq!(running.receive("source"), "up");
    let (code, _, said) = run(&["id: a, args: -c true"], &["--graph", name]);
    assert_eq!(code, 1, "{said}");
    assert!(said.contains("graph test-alive still runs"), "{said}");
    assert!(!shared_memory_of(name).is_empty());
    let mut writer = OpenOptions::new().write(true).open(&pipe).unwrap();
    std::io::Write::write_all(&mut writer, b"\n").unwrap();
    let (status, said) = running.wait();
    assert_eq!(status.code(), Some(0), "{said}");
    assert_eq!(shared_memory_of(name), [""; 0]);
}

#[test]
fn a_name_that_another_user_has_taken_is_refused_and_the_user_named() {
    if !nix::unistd::geteuid().is_root() {
        let test = "a_name_that_another_user_has_taken_is_refused_and_the_user_named";
        Need::Root.is_missing(test, "nobody else can act as two users");
        return;
    }
    let file = Path::new("/dev/shm/bc12345_test-foreign.in_the_way");
    fs::write(file, "").unwrap();
    let folder = graph(&["id: a, args: -c true"]);
    let user = Some(nix::unistd::Uid::from_raw(12_345));
    nix::unistd::chown(folder.path(), user, None).unwrap();
    let output = launcher(folder.path(), &["--graph", "test-foreign"])
        .uid(12_345)
        .output();
    fs::remove_file(file).unwrap();
    let output = output.unwrap();
    let said = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(1), "{said}");
    assert!(said.contains("in_the_way belongs to user 0"), "{said}");
    assert!(said.contains("--graph"), "{said}");
}

#[test]
fn others_have_no_rights_on_the_files_of_a_graph() {
    let name = "test-rights";
    let folder = graph(&["id: source, outputs: [scan], args: -c 'echo up; read line < pipe'"]);
    let pipe = folder.path().join("pipe");
    mkfifo(&pipe, Mode::S_IRWXU).unwrap();
    let mut running = Running::start(&folder, &["--graph", name]);
    assert_eq!(running.receive("source"), "up");
    let files = shared_memory_of(name);
    assert!(files.len() > 3, "{files:?}");
    for file in files {
        use std::os::unix::fs::PermissionsExt;
        let mode = fs::metadata(Path::new("/dev/shm").join(&file))
            .unwrap()
            .permissions()
            .mode();
        assert_eq!(mode & 0o077, 0, "{file}: {mode:o}");
    }
    running.signal(Signal::SIGHUP);
    let (status, said) = running.wait();
    assert_eq!(status.code(), Some(0), "a hangup stops in order: {said}");
}

#[test]
fn a_graph_whose_files_are_removed_is_started_again_as_a_whole() {
    let name = "test-cleaned";
    let folder = graph(&["id: source, outputs: [scan], args: -c 'echo up; read line < pipe'"]);
    let pipe = folder.path().join("pipe");
    mkfifo(&pipe, Mode::S_IRWXU).unwrap();
    let mut running = Running::start(&folder, &["--graph", name]);
    assert_eq!(running.receive("source"), "up");
    let root = format!("/tmp/backcast-{}", nix::unistd::geteuid());
    remove_files_of(Path::new(&root), &format!("_{name}."));
    assert_eq!(running.receive("source"), "up", "a second time");
    let mut writer = OpenOptions::new().write(true).open(&pipe).unwrap();
    std::io::Write::write_all(&mut writer, b"\n").unwrap();
    let (status, said) = running.wait();
    assert_eq!(status.code(), Some(0), "{said}");
    assert_eq!(shared_memory_of(name), [""; 0]);
}

/// As whatever cleans temporary folders does.
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
        "id: other, args: \"-c 'exec sleep 1000'\"",
    ]);
    let mut running = Running::start(&folder, &["--graph", name]);
    assert_eq!(running.receive("source"), "up");
    let ask = |args: &[&str]| {
        let args = [args, &["--graph", name]].concat();
        let output = launcher(folder.path(), &args).output().unwrap();
        let text = |bytes| String::from_utf8(bytes).unwrap();
        (
            output.status.code(),
            text(output.stdout),
            text(output.stderr),
        )
    };
    let (code, stdout, said) = ask(&["status", "--json"]);
    assert_eq!(code, Some(0), "{said}");
    let status: serde_json::Value = serde_json::from_str(&stdout).unwrap();
    assert_eq!(
        (&status["graph"], &status["nodes"][0]["state"]),
        (&name.into(), &"running".into())
    );
    let before = status["nodes"][0]["pid"].clone();

    let (code, _, said) = ask(&["restart", "sauce"]);
    assert_eq!(code, Some(2), "{said}");
    assert!(
        said.contains("no node sauce: allowed are source, other"),
        "{said}"
    );
    let (code, _, said) = ask(&["restart", "source"]);
    assert_eq!(code, Some(0), "{said}");
    assert_eq!(running.receive("source"), "up", "a second time");
    let (_, stdout, _) = ask(&["status", "--json"]);
    let status: serde_json::Value = serde_json::from_str(&stdout).unwrap();
    assert_ne!(status["nodes"][0]["pid"], before);
    assert_eq!(status["nodes"][0]["restarts"], 1);
    assert!(ask(&["status"]).1.contains("source               running"));

    let (code, stdout, said) = ask(&["logs", "backcast"]);
    assert_eq!(code, Some(0), "{said}");
    assert!(
        stdout.contains("source is restarted from another terminal"),
        "{stdout}"
    );

    let (code, _, said) = ask(&["stop"]);
    assert_eq!(code, Some(0), "{said}");
    let (status, said) = running.wait();
    assert_eq!(status.code(), Some(0), "{said}");
    let (code, _, said) = ask(&["stop"]);
    assert_eq!(code, Some(1), "{said}");
    assert!(
        said.contains("no launcher of graph test-control answers"),
        "{said}"
    );
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
fn a_signal_stops_even_what_does_not_want_to() {
    let folder = graph(&[
        "id: polite, args: \"-c 'echo $$; exec sleep 1000'\"",
        "id: stubborn, args: \"-c 'trap : TERM; echo $$; while :; do sleep 1000; done'\"",
        "id: parent, args: \"-c 'sleep 1000 & echo $!; wait'\"",
    ]);
    for signal in [Signal::SIGINT, Signal::SIGTERM] {
        let mut running = Running::start(&folder, &["--graph", "test-stop"]);
        // The order of what different nodes say is theirs.
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
    // Opening waits for the node to open its end; reading, for it to end.
    let mut reader = File::open(&pipe).unwrap();
    assert_eq!(running.receive("a"), "up");
    running.signal(Signal::SIGKILL);
    let mut rest = String::new();
    reader.read_to_string(&mut rest).unwrap();
    let (status, _) = running.wait();
    assert_eq!(status.signal(), Some(9));
    transport::remove_leftovers(&GraphName::new("test-kill").unwrap()).unwrap();
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

/// The scan `counter`, measured at `counter` milliseconds.
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

    // Writing lets the source end, and the run with it.
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
