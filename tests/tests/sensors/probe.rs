//! `backcast probe` with emulated lasers, and with other things.

use std::io::Write;
use std::net::{TcpListener, TcpStream};
use std::path::Path;

use messages::topic;
use tests::executables;
use tests::world::World;
use transport::testing::{Isolated, NodeProcess, wait_for_health};

/// Exit code, standard output and standard error.
fn probe(device: &str) -> (i32, String, String) {
    tests::said_by(executables::backcast().args(["probe", device, "--width", "60"]))
}

/// Returns the output about an emulated device with these arguments; `device` makes the probe's
/// argument from the graph's own host.
fn emulated(tag: &str, arguments: &[&str], device: impl Fn(&str) -> String) -> String {
    let path = executables::path("emulator");
    let _ = executables::path("backcast");
    let isolated = Isolated::new(tag);
    let graph = isolated.join("test");
    let health = graph.subscriber::<topic::Health>().unwrap();
    let recording = World::of("malaga_corridor").recording();
    let source = ["--recording", recording.to_str().unwrap()];
    let emulator = [&source, arguments].concat();
    let emulator = NodeProcess::start(path.to_str().unwrap(), &graph, &emulator);
    let device = device(&graph.name().loopback().to_string());
    // It may report its health before it listens.
    wait_for_health(&graph, &health, |report| {
        report.node.as_str() == "emulator" && is_there(&device)
    });
    let (code, said, complained) = probe(&device);
    assert_eq!((code, complained.as_str()), (0, ""), "{said}");
    emulator.stop();
    said
}

/// True if the first port accepts connections, or the link exists.
fn is_there(device: &str) -> bool {
    match device.starts_with('/') {
        true => Path::new(device).exists(),
        false => TcpStream::connect((device.trim_start_matches("tcp://"), 2112)).is_ok(),
    }
}

/// Checks the picture: the corridor's walls are on both sides of the laser.
fn has_a_picture(said: &str) {
    let is_dot = |c: char| ('\u{2801}'..='\u{28ff}').contains(&c);
    let dots = said.chars().filter(|&c| is_dot(c)).count();
    assert!(dots > 50, "{dots} characters in {said}");
    assert!(said.contains("ahead is up"), "{said}");
}

#[test]
fn cola_in_either_encoding() {
    for (tag, protocol, name) in [
        ("probea", "cola-a", "CoLa A"),
        ("probeb", "cola-b", "CoLa B"),
    ] {
        let arguments = ["--listen", "tcp://graph:2112", "--protocol", protocol];
        // Without a port, both usual ports are tried.
        let said = emulated(tag, &arguments, |host| format!("tcp://{host}"));
        let answers = format!(":2112: answers {name}");
        for part in [
            &*answers,
            "LMS111 emulated",
            "every 0.5°, from 0° to 180°",
            "90° is ahead, angles grow counter-clockwise",
            "a scan of 361 readings",
        ] {
            assert!(said.contains(part), "{part}: {said}");
        }
        has_a_picture(&said);
    }
}

#[test]
fn a_clockwise_device_by_its_address_alone() {
    let arguments = ["--listen", "tcp://graph:2112", "--device", "NAV310"];
    let said = emulated("probenav", &arguments, str::to_owned);
    let clockwise = "180° is ahead, angles grow clockwise (as a NAV310";
    assert!(said.contains(clockwise), "{said}");
    has_a_picture(&said);
}

#[test]
fn an_lms2xx_at_its_baud_rate() {
    let folder = tempfile::tempdir().unwrap();
    let link = folder.path().join("laser");
    let link = link.to_str().unwrap();
    let arguments = ["--pty", link, "--baud", "500000"];
    let said = emulated("probelms", &arguments, |_| link.to_owned());
    assert!(said.contains("an LMS2xx at 500000 baud"), "{said}");
    assert!(said.contains("LMS291"), "{said}");
    assert!(said.contains("180° at 0.5°"), "{said}");
    has_a_picture(&said);
}

#[test]
fn what_is_no_laser_is_distinguished() {
    let fails = |device: &str, expected: &str| {
        let (code, said, complained) = probe(device);
        assert_eq!((code, said.as_str()), (1, ""), "{complained}");
        assert!(complained.contains(expected), "{complained}");
    };
    let free = TcpListener::bind("127.0.0.1:0").unwrap();
    let address = |listener: &TcpListener| format!("tcp://{}", listener.local_addr().unwrap());
    let refused = address(&free);
    drop(free);
    fails(&refused, "Connection refused");
    fails("/dev/no_such_laser", "No such file");
    fails(
        Path::new(file!()).to_str().unwrap(),
        "no device can be reached",
    );

    // The connection is accepted by the system, and stays silent.
    let silent = TcpListener::bind("127.0.0.1:0").unwrap();
    fails(&address(&silent), "nothing came");

    let other = TcpListener::bind("127.0.0.1:0").unwrap();
    let target = address(&other);
    let server = std::thread::spawn(move || {
        for _ in 0..2 {
            let (mut stream, _) = other.accept().unwrap();
            stream.write_all(b"220 mail.example ready\r\n").unwrap();
            // It stays until the probe closes the connection.
            let _ = std::io::copy(&mut stream, &mut std::io::sink());
        }
    });
    fails(&target, "48 bytes received that are not an answer");
    server.join().unwrap();
}
