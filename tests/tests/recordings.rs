//! Recordings that the graph makes: they stay the same when they are played and recorded again, and
//! report what they have lost.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};
use std::process::Stdio;

use nix::sys::signal::{Signal, kill};
use nix::unistd::Pid;
use recording::write::{Packing, RecordingWriter};
use recording::{Kind, Recording};
use tempfile::TempDir;
use tests::executables;
use tests::recorded::{graph, messages, record};
use tests::schemas::assert_follows;
use tests::world::{World, scans_of};

/// Topics whose messages contain durations or times of sending.
const TIMED: [&str; 4] = [
    "/backcast/votes",
    "/backcast/hypotheses",
    "/backcast/beams",
    "/backcast/pose",
];

/// Topics on which nodes report about themselves.
const SPOKEN: [&str; 2] = ["/diagnostics", "/rosout"];

#[test]
fn a_recording_of_a_recording_is_the_same_message_for_message() {
    let world = World::of("malaga_corridor");
    let folder = TempDir::new().unwrap();
    let [imported, first, second] =
        ["0.mcap", "a.mcap", "b.mcap"].map(|name| folder.path().join(name));
    // The recording of the repository has headings with other last bits, and the tracker computes
    // with them.
    record(&world.recording(), &world.map(), &imported);
    record(&imported, &world.map(), &first);
    record(&first, &world.map(), &second);
    // Several processes send messages of the same time, in any order.
    let [first, second] = [first, second].map(|recording| {
        let mut all = messages(&recording);
        all.values_mut().for_each(|of_topic| of_topic.sort());
        all
    });
    let topics: Vec<&String> = first.keys().collect();
    assert_eq!(topics, second.keys().collect::<Vec<_>>());
    for (topic, messages) in &first {
        let times = |messages: &[(i64, Vec<u8>)]| -> Vec<i64> {
            messages.iter().map(|(time, _)| *time).collect()
        };
        match topic.as_str() {
            spoken if SPOKEN.contains(&spoken) => assert!(!messages.is_empty()),
            timed if TIMED.contains(&timed) => {
                assert_eq!(times(messages), times(&second[topic]), "{topic}");
            }
            _ => {
                let again = &second[topic];
                let differs = messages.iter().zip(again).position(|(a, b)| a != b);
                let found = (messages.len(), again.len());
                assert!(
                    *messages == *again,
                    "{topic} differs at {differs:?} of {found:?}"
                );
            }
        }
    }
    // Poses are recorded only while the tracker believes a place.
    assert!(!first["/pose"].is_empty() && first["/pose"].len() < first["/scan"].len());
    // The recording itself comes back too, except for data that the graph does not carry: the
    // height of the laser and the last bits of angles.
    assert_evaluates_alike(&imported, &world.recording());
    let original = messages(&world.recording());
    for topic in ["/scan", "/odom", "/ground_truth", "/map", "/tf_static"] {
        assert_eq!(first[topic].len(), original[topic].len(), "{topic}");
    }
    for topic in [
        "/hypotheses",
        "/backcast/pose",
        "/backcast/votes",
        "/backcast/hypotheses",
        "/backcast/beams",
    ] {
        assert_eq!(first[topic].len(), original["/scan"].len(), "{topic}");
    }
}

/// Checks that scans, true poses and map are those of the recording that was played.
fn assert_evaluates_alike(recorded: &Path, played: &Path) {
    let ranges = |path: &Path| -> Vec<Vec<f32>> {
        let scans = scans_of(path).into_iter();
        scans.map(|scan| scan.ranges).collect()
    };
    assert_eq!(ranges(recorded), ranges(played));
    let [recorded, played] = [recorded, played].map(|path| Recording::open(path).unwrap());
    let [found, truths] = [&recorded, &played].map(|of| of.ground_truths().unwrap());
    assert_eq!(found.len(), truths.len());
    for (stamp, truth) in truths {
        // The yaw is rounded to 2⁻⁴⁰ rad.
        let is_near = truth.pose.is_within(found[&stamp].pose, 0.0, 1e-12);
        assert!(is_near, "{stamp}");
    }
    let [found, map] = [&recorded, &played].map(|of| of.map().unwrap().unwrap());
    assert_eq!(found.cells, map.cells);
}

#[test]
fn a_launcher_that_is_asked_to_save_asks_the_recorder() {
    let world = World::of("malaga_corridor");
    let folder = TempDir::new().unwrap();
    let descriptor = folder.path().join("graph.yaml");
    std::fs::write(&descriptor, graph(&world.recording(), &world.map())).unwrap();
    let output = folder.path().join("box.mcap");
    let mut launcher = executables::backcast()
        .arg("run")
        .arg(&descriptor)
        .args([
            "--json", "--rate", "max", "--loop", "--keep", "1m", "--record",
        ])
        .arg(&output)
        .stdout(Stdio::piped())
        .spawn()
        .unwrap();
    let mut poses = BufReader::new(launcher.stdout.take().unwrap()).lines();
    // The source has waited for the recorder.
    poses.next().unwrap().unwrap();
    let pid = Pid::from_raw(launcher.id().cast_signed());
    kill(pid, Signal::SIGUSR1).unwrap();
    let is_whole = || Recording::open(&output).is_ok_and(|r| r.damage().is_none());
    while !is_whole() {
        std::thread::yield_now();
    }
    kill(pid, Signal::SIGTERM).unwrap();
    assert_eq!(launcher.wait().unwrap().code(), Some(0));
    let saved = Recording::open(&output).unwrap();
    let reason = &saved.metadata()[0].entries["reason"];
    assert_eq!(reason, "asked by SIGUSR1");
    assert!(saved.topic(Kind::Scan).unwrap().is_some());
}

/// Makes a case whose recording ends in the middle; returns its folder and the number of scans
/// left.
fn cut_short(folder: &TempDir) -> (PathBuf, u64) {
    let world = World::of("malaga_corridor");
    let case = folder.path().join("cut");
    std::fs::create_dir(&case).unwrap();
    for file in ["map.yaml", "map.png", "expected.json"] {
        std::fs::copy(world.folder.join(file), case.join(file)).unwrap();
    }
    let mut writer = RecordingWriter::in_memory(Packing::Zstd).unwrap();
    for record in Recording::open(world.recording()).unwrap().raw_records() {
        let record = record.unwrap();
        let (channel, time) = (record.channel, record.log_time_ns);
        writer
            .write_bytes(
                &channel.topic,
                &channel.schema,
                "",
                "cdr",
                time,
                &record.body,
            )
            .unwrap();
        writer.flush().unwrap();
    }
    let bytes = writer.finish().unwrap().into_inner();
    let path = case.join("recording.mcap");
    std::fs::write(&path, &bytes[..bytes.len() / 2]).unwrap();
    let cut = Recording::open(&path).unwrap();
    let mut channels = cut.channels();
    let scans = channels.find(|channel| &*channel.topic == "/scan").unwrap();
    (case, scans.messages)
}

#[test]
fn what_a_recording_has_lost_is_reported_and_drawn() {
    let folder = TempDir::new().unwrap();
    let (case, scans) = cut_short(&folder);
    assert!((1..37).contains(&scans), "{scans}");
    let descriptor = folder.path().join("graph.yaml");
    let recording = case.join("recording.mcap");
    std::fs::write(&descriptor, graph(&recording, &case.join("map.yaml"))).unwrap();

    let played = executables::backcast()
        .args(["run", "--rate", "max"])
        .arg(&descriptor)
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&played.stderr);
    assert_eq!(played.status.code(), Some(3), "{said}");
    assert!(said.contains("the file is cut short"), "{said}");
    assert!(said.contains("replayer lost data"), "{said}");
    let printed = String::from_utf8_lossy(&played.stdout);
    let all = format!("scans      {scans}, answered {scans}");
    assert!(printed.contains(&all), "{printed}");

    let compared = executables::backcast()
        .arg("regress")
        .arg(&case)
        .arg("--dataflow")
        .arg(&descriptor)
        .output()
        .unwrap();
    assert_eq!(compared.status.code(), Some(1));
    let verdict = String::from_utf8_lossy(&compared.stdout);
    // The scans that were played are as expected; the others are missing.
    let missing = 37 - scans;
    let expected = format!("was played and compared, with {missing} differences");
    assert!(verdict.contains("the file is cut short"), "{verdict}");
    assert!(verdict.contains(&expected), "{verdict}");
}

/// Stops a process for longer than its topics can queue messages, repeatedly until it ends.
fn stall(child: &mut std::process::Child) -> std::process::ExitStatus {
    let pid = Pid::from_raw(child.id().cast_signed());
    let pause = |time| std::thread::sleep(std::time::Duration::from_millis(time));
    loop {
        // The process id stays its own until it is waited for, even after its end.
        if let Some(status) = child.try_wait().unwrap() {
            return status;
        }
        pause(300);
        kill(pid, Signal::SIGSTOP).unwrap();
        pause(600);
        kill(pid, Signal::SIGCONT).unwrap();
    }
}

#[test]
fn who_looks_on_and_stands_still_for_a_while_misses_nothing() {
    let world = World::of("malaga_corridor");
    let folder = TempDir::new().unwrap();
    let descriptor = folder.path().join("graph.yaml");
    std::fs::write(&descriptor, graph(&world.recording(), &world.map())).unwrap();
    let start = |args: &[&str]| {
        let mut command = executables::backcast();
        command.args(args).current_dir(tests::root());
        // A pipe could fill up while no one reads it.
        let [printed, said] = ["printed", "said"].map(|name| folder.path().join(name));
        command.stdout(std::fs::File::create(&printed).unwrap());
        command.stderr(std::fs::File::create(&said).unwrap());
        let status = stall(&mut command.spawn().unwrap());
        let [printed, said] = [printed, said].map(|file| std::fs::read_to_string(file).unwrap());
        assert_eq!(status.code(), Some(0), "{args:?}: {said}");
        printed
    };
    let printed = start(&["regress", "--json", world.folder.to_str().unwrap()]);
    assert_follows("regress", &printed);
    let descriptor = descriptor.to_str().unwrap();
    let printed = start(&["run", descriptor, "--json", "--rate", "max"]);
    let of_scan = |line: &&str| {
        let is_of_scan = !line.starts_with(r#"{"schema":3,"summary""#);
        assert_follows(if is_of_scan { "run" } else { "run_summary" }, line);
        is_of_scan
    };
    assert_eq!(printed.lines().filter(of_scan).count(), 37, "{printed}");
}
