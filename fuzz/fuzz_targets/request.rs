//! Any request to the monitor's page: method, path and body, with the token. Nothing panics, every
//! request is answered, and requests passed to the graph are valid. After `WATCH`, the body is sent
//! by a viewer on its WebSocket.
#![no_main]

use std::io::{ErrorKind, Read, Write};
use std::net::{Shutdown, SocketAddr, TcpListener, TcpStream};
use std::os::unix::fs::PermissionsExt;
use std::sync::mpsc::Receiver;
use std::sync::{LazyLock, Mutex};
use std::time::Duration;

use dashboard::{Abilities, Options, Request, Robot, Robots, Server};
use libfuzzer_sys::fuzz_target;

const TOKEN: &str = "fuzzed-fuzzed-fuzzed";

/// Page with one robot, `r`, that accepts every request.
struct Page {
    address: SocketAddr,
    requests: Mutex<Receiver<Request>>,
    _server: Server,
}

static PAGE: LazyLock<Page> = LazyLock::new(|| {
    let folder = tempfile::tempdir().unwrap();
    let token = folder.path().join("token");
    std::fs::write(&token, TOKEN).unwrap();
    std::fs::set_permissions(&token, std::fs::Permissions::from_mode(0o600)).unwrap();
    let (robot, requests) = Robot::new("r".into(), None);
    robot.on_abilities(Abilities {
        region: true,
        save: true,
        hint: true,
        restart: true,
    });
    let options = Options {
        webhook: None,
        host: Vec::new(),
        token_file: Some(token),
    };
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    let address = listener.local_addr().unwrap();
    drop(listener);
    let robots = Robots::default();
    robots.add(robot);
    let server = Server::start(address, &options, robots).unwrap();
    Page {
        address,
        requests: Mutex::new(requests),
        _server: server,
    }
});

/// Returns the answer, or the part of it that arrived; `None` if the connection stays open too
/// long.
fn read_all(stream: &mut TcpStream) -> Option<Vec<u8>> {
    let mut answer = Vec::new();
    match stream.read_to_end(&mut answer) {
        Err(error) if error.kind() == ErrorKind::WouldBlock => None,
        // A reset happens if the server has not read everything that was sent.
        _ => Some(answer),
    }
}

fn connect() -> TcpStream {
    let stream = TcpStream::connect(PAGE.address).unwrap();
    let patience = Some(Duration::from_secs(10));
    stream.set_read_timeout(patience).unwrap();
    stream
}

fn ask(method: &str, path: &[u8], body: &[u8]) {
    let mut stream = connect();
    let host = PAGE.address;
    let mut request = [method.as_bytes(), b" ", path, b" HTTP/1.1\r\n"].concat();
    let length = body.len();
    request.extend_from_slice(
        format!(
            "host: {host}\r\nauthorization: Bearer {TOKEN}\r\nconnection: close\r\n\
             content-type: application/json\r\ncontent-length: {length}\r\n\r\n"
        )
        .as_bytes(),
    );
    request.extend_from_slice(body);
    // A server that refuses early closes the connection during this write.
    let _ = stream.write_all(&request);
    let answer = read_all(&mut stream).expect("a request without an answer");
    let status = answer.get(9..12);
    assert!(
        !matches!(status, Some(b"500" | b"501" | b"502")),
        "{}",
        answer.escape_ascii()
    );
}

fn watch(path: &[u8], sent: &[u8]) {
    let mut stream = connect();
    let mut request = [b"GET ", path, b" HTTP/1.1\r\n"].concat();
    let host = PAGE.address;
    request.extend_from_slice(
        format!(
            "host: {host}\r\nconnection: Upgrade\r\nupgrade: websocket\r\n\
             sec-websocket-version: 13\r\nsec-websocket-key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n"
        )
        .as_bytes(),
    );
    let _ = stream.write_all(&request);
    let mut first = [0; 12];
    if stream.read_exact(&mut first).is_ok() && first.ends_with(b"101") {
        let _ = stream.write_all(sent);
        let _ = stream.shutdown(Shutdown::Write);
        read_all(&mut stream).expect("a viewer that left is still served");
    }
}

fuzz_target!(|bytes: &[u8]| {
    let mut lines = bytes.splitn(2, |&b| b == b'\n');
    let (Some(line), Some(body)) = (lines.next(), lines.next()) else {
        return;
    };
    let mut words = line.splitn(2, |&b| b == b' ');
    let (Some(method), Some(path)) = (words.next(), words.next()) else {
        return;
    };
    // Spaces and control characters end a path.
    if path.is_empty() || path.iter().any(|&b| b <= b' ') {
        return;
    }
    match method {
        b"WATCH" => watch(path, body),
        b"GET" => ask("GET", path, body),
        b"PUT" => ask("PUT", path, body),
        b"POST" => ask("POST", path, body),
        b"DELETE" => ask("DELETE", path, body),
        _ => return,
    }
    for request in PAGE.requests.lock().unwrap().try_iter() {
        if let Request::Region(corners) = request {
            assert!(corners.is_empty() || engine::limits::Region::new(&corners).is_ok());
        }
    }
});
