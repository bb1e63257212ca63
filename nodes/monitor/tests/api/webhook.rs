//! State changes posted to the user's server.

use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpListener;

use messages::{TrackState, topic};
use serde_json::{Value, json};
use transport::testing::wait_until;

use crate::world::World;

/// Age of a scan stamped one hour ahead, in seconds, so that it does not become old during the
/// test, which would be a further state change.
const FRESH: i64 = -3600;

/// Accepts a request and answers it with a status; returns its first line and its body.
fn take(listener: &TcpListener, status: &str) -> (String, Value) {
    let (mut stream, _) = listener.accept().unwrap();
    let mut lines = BufReader::new(stream.try_clone().unwrap());
    let mut head = String::new();
    while !head.ends_with("\r\n\r\n") {
        assert!(lines.read_line(&mut head).unwrap() > 0, "{head}");
    }
    let head = head.to_ascii_lowercase();
    assert!(
        head.contains("content-type: application/json\r\n"),
        "{head}"
    );
    let length = head.split("content-length: ").nth(1).unwrap();
    let length = length.lines().next().unwrap().parse().unwrap();
    let mut body = vec![0; length];
    lines.read_exact(&mut body).unwrap();
    let answer = format!("HTTP/1.1 {status}\r\nContent-Length: 0\r\nConnection: close\r\n\r\n");
    stream.write_all(answer.as_bytes()).unwrap();
    let first = head.lines().next().unwrap().to_owned();
    (first, serde_json::from_slice(&body).unwrap())
}

#[test]
fn each_change_of_state_is_posted() {
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    let server = format!("http://{}/robots?key=7", listener.local_addr().unwrap());
    let world = World::with("webhook", &["--webhook", &server]);
    let log = world.graph.subscriber::<topic::Log>().unwrap();
    world.track(1, TrackState::Unique, 1.5, FRESH);
    let (request, first) = take(&listener, "204 No Content");
    assert_eq!(request, "post /robots?key=7 http/1.1");
    let expected = json!({"robot": "r", "state": "Unique", "before": null, "schema": 3});
    for (key, value) in expected.as_object().unwrap() {
        assert_eq!(&first[key], value, "{first}");
    }
    assert_eq!(first["graph"], world.graph.name().as_str());
    assert!(first["since_s"].as_f64().unwrap() > 1.7e9, "{first}");
    // The same state again is no change; a post that is refused is logged and not repeated.
    world.track(2, TrackState::Unique, 1.75, FRESH);
    world.track(3, TrackState::Lost, 2.0, FRESH);
    let (_, lost) = take(&listener, "500 Broken");
    assert_eq!([&lost["state"], &lost["before"]], ["Lost", "Unique"]);
    assert_eq!(lost["before_pose"]["x"], 1.75);
    assert_eq!(lost["why"], "one place is left");
    let mut logged = String::new();
    wait_until(&world.graph, &log, |_, text| {
        logged = String::from_utf8_lossy(text).into_owned();
        logged.starts_with("webhook: ")
    });
    assert!(logged.contains("webhook: 1 not posted"), "{logged}");
    assert!(
        logged.contains("500") && !logged.contains("key=7"),
        "{logged}"
    );
    world.track(4, TrackState::Unique, 3.0, FRESH);
    let (_, found) = take(&listener, "200 OK");
    assert_eq!([&found["state"], &found["before"]], ["Unique", "Lost"]);
    // The server is gone, which does not affect the page.
    drop(listener);
    world.track(5, TrackState::Doubtful, 3.0, FRESH);
    let known = world.wait_for_state(|known| known["pose"]["counter"] == 5);
    assert_eq!(known["pose"]["state"], "Doubtful");
}
