//! The API as anybody sees it from outside: over TCP, with a graph behind it.
#![allow(
    clippy::unwrap_used,
    reason = "the lint spares test functions but not what they share"
)]

use std::io::Read;
use std::net::{SocketAddr, TcpStream};
use std::path::Path;

use bytemuck::Zeroable;
use messages::{
    BeamsHeader, Corner, FieldHeader, HypothesesHeader, Hypothesis, MapHeader, Pose2, PoseHeader,
    TrackState, Verdict, topic,
};
use serde_json::{Value, json};
use tempfile::TempDir;
use tests::http::{Site, token_file};
use transport::testing::{Isolated, NodeProcess, wait_for, wait_until_ready};
use transport::{Flow, Graph, Publisher, TransportError};
use tungstenite::{Message, WebSocket, client};

const TOKEN: &str = "0123456789abcdef";

const CELLS: [u8; 6] = [0, 100, 255, 0, 0, 100];

fn map_header() -> MapHeader {
    let mut header = MapHeader {
        width: 3,
        height: 2,
        resolution_m: 0.05,
        ..MapHeader::zeroed()
    };
    header.map_id = header.id_of(&CELLS);
    header
}

/// As the API says it.
fn map_name() -> String {
    format!("{:016x}", map_header().map_id)
}

/// The node in a graph of its own, and what it may be asked.
struct World {
    node: Option<NodeProcess>,
    site: Site,
    hypotheses: Publisher<topic::Hypotheses>,
    poses: Publisher<topic::Tracked>,
    beams: Publisher<topic::Beams>,
    maps: Publisher<topic::Map>,
    graph: Graph,
    _isolated: Isolated,
    _folder: TempDir,
}

impl World {
    fn new(test: &str) -> World {
        let isolated = Isolated::new(test);
        let graph = isolated.join("test");
        let folder = tempfile::tempdir().unwrap();
        let token = token_file(folder.path(), TOKEN);
        let site = Site::free();
        let mut world = World {
            node: None,
            site,
            hypotheses: graph.publisher().unwrap(),
            poses: graph.publisher().unwrap(),
            beams: graph.publisher().unwrap(),
            maps: graph.publisher().unwrap(),
            graph,
            _isolated: isolated,
            _folder: folder,
        };
        world.serve_map();
        world.node = Some(start(&world.graph, world.site.0, &token));
        wait_until_ready(&world.graph, "monitor");
        world
    }

    fn serve_map(&self) {
        let mut loan = self.maps.loan(CELLS.len()).unwrap();
        *loan.header_mut() = map_header();
        loan.items_mut().copy_from_slice(&CELLS);
        loan.send().unwrap();
    }

    fn answer(&self, counter: u64, x: f64) {
        let mut loan = self.hypotheses.loan(1).unwrap();
        let header = loan.header_mut();
        *header = HypothesesHeader {
            map_id: map_header().map_id,
            verdict: Verdict::Unique as u32,
            ..HypothesesHeader::zeroed()
        };
        header.stamp.counter = counter;
        loan.items_mut()[0] = Hypothesis {
            map_from_laser: Pose2 {
                x,
                y: 2.0,
                yaw: 0.5,
            },
            ..Hypothesis::zeroed()
        };
        loan.send().unwrap();
    }

    /// Sends where the tracker has the robot, by a scan that came `age_s` ago.
    fn track(&self, counter: u64, state: TrackState, x: f64, age_s: i64) {
        let words = b"one place is left";
        let mut loan = self.poses.loan(words.len()).unwrap();
        let header = loan.header_mut();
        *header = PoseHeader {
            map_id: map_header().map_id,
            sent_ns: transport::monotonic_ns(),
            map_from_laser: Pose2 {
                x,
                y: 2.0,
                yaw: 0.5,
            },
            state: state as u32,
            from_scan: 1,
            pose_known: 1,
            ..PoseHeader::zeroed()
        };
        header.stamp.counter = counter;
        header.stamp.entered_ns = header.sent_ns - age_s * 1_000_000_000;
        loan.items_mut().copy_from_slice(words);
        loan.send().unwrap();
    }

    /// Asks until the answer is as it should be; the graph continues meanwhile.
    fn wait_for_state(&self, is_awaited: impl Fn(&Value) -> bool) -> Value {
        let mut found = None;
        let tick = std::time::Duration::from_millis(20);
        self.graph
            .run(&[], tick, |_| {
                found = Some(self.site.get("/api/v1/robots/r")).filter(&is_awaited);
                let flow = if found.is_some() {
                    Flow::Stop
                } else {
                    Flow::Continue
                };
                Ok::<_, TransportError>(flow)
            })
            .unwrap();
        found.unwrap()
    }

    fn stream(&self) -> WebSocket<TcpStream> {
        let url = format!("ws://{}/api/v1/robots/r/stream", self.site.0);
        let stream = TcpStream::connect(self.site.0).unwrap();
        client(url, stream).unwrap().0
    }
}

impl Drop for World {
    fn drop(&mut self) {
        if let Some(node) = self.node.take()
            && !std::thread::panicking()
        {
            node.stop();
        }
    }
}

fn start(graph: &Graph, address: SocketAddr, token: &Path) -> NodeProcess {
    let (address, token) = (address.to_string(), token.to_str().unwrap());
    NodeProcess::start(
        env!("CARGO_BIN_EXE_monitor"),
        graph,
        ["--listen", &address, "--robot", "r", "--token-file", token],
    )
}

fn next(socket: &mut WebSocket<TcpStream>) -> Value {
    loop {
        if let Message::Text(text) = socket.read().unwrap() {
            return serde_json::from_str(&text).unwrap();
        }
    }
}

fn next_of(socket: &mut WebSocket<TcpStream>, kind: &str) -> Value {
    loop {
        let message = next(socket);
        if message["type"] == kind {
            return message;
        }
    }
}

#[test]
fn what_flows_in_the_graph_is_reported() {
    let world = World::new("flow");
    let robots = world.site.get("/api/v1/robots");
    assert_eq!(robots["robots"], json!(["r"]));
    let known = world.wait_for_state(|known| !known["map"].is_null());
    assert_eq!(known["map"]["id"], map_name());
    let mut socket = world.stream();
    assert_eq!(next(&mut socket)["type"], "snapshot");
    world.answer(7, 1.5);
    let answer = next_of(&mut socket, "answer");
    assert_eq!(answer["verdict"], "Unique");
    assert_eq!(answer["hypotheses"][0]["laser"]["x"], 1.5);
    let mut loan = world.beams.loan(1).unwrap();
    *loan.header_mut() = BeamsHeader::zeroed();
    loan.send().unwrap();
    assert_eq!(next_of(&mut socket, "beams")["fate"], "h");
    // A later viewer gets the same at once.
    let known = world.site.get("/api/v1/robots/r");
    assert_eq!(known["answer"]["counter"], 7);
    let names: Vec<&Value> = known["nodes"]
        .as_array()
        .unwrap()
        .iter()
        .map(|n| &n["name"])
        .collect();
    assert_eq!(names, ["monitor"]);
}

#[test]
fn the_trackers_pose_is_reported_with_its_age() {
    let world = World::new("tracked");
    world.wait_for_state(|known| !known["map"].is_null());
    let mut socket = world.stream();
    assert_eq!(next(&mut socket)["pose"], Value::Null, "no tracker yet");
    world.answer(7, 9.0);
    world.track(7, TrackState::Unique, 1.5, 61);
    let pose = next_of(&mut socket, "pose");
    assert_eq!(
        (&pose["state"], &pose["laser"]["x"]),
        (&json!("Unique"), &json!(1.5))
    );
    assert_eq!(pose["says"], "one place is left");
    let known = world.site.get("/api/v1/robots/r");
    assert_eq!(known["pose"]["counter"], 7);
    assert_eq!(known["answer"]["hypotheses"][0]["laser"]["x"], 9.0);
    assert_eq!(known["track"], json!([[1.5, 2.0, "U", 0.5]]));
    // A later viewer gets its age.
    let age_s = known["ages"]["scan_s"].as_f64().unwrap();
    assert!(age_s >= 61.0, "{age_s}");
}

#[test]
fn the_map_is_a_byte_a_cell() {
    let world = World::new("map");
    world.wait_for_state(|known| !known["map"].is_null());
    let path = "/api/v1/robots/r/map";
    let request = |more: &str| {
        format!(
            "GET {path} HTTP/1.1\r\nHost: {}\r\n{more}Connection: close\r\n\r\n",
            world.site.0
        )
    };
    let (status, _, cells) = world.site.raw(request("").as_bytes());
    assert_eq!((status, cells), (200, vec![0, 100, 255, 0, 0, 100]));
    let (status, _, cells) = world
        .site
        .raw(request(&format!("If-None-Match: \"{}\"\r\n", map_name())).as_bytes());
    assert_eq!((status, cells.len()), (304, 0), "the reader has it");
    let (_, head, packed) = world
        .site
        .raw(request("Accept-Encoding: gzip\r\n").as_bytes());
    assert!(head.contains("content-encoding: gzip"), "{head}");
    let mut cells = Vec::new();
    flate2::read::GzDecoder::new(&packed[..])
        .read_to_end(&mut cells)
        .unwrap();
    assert_eq!(cells, [0, 100, 255, 0, 0, 100]);
}

#[test]
fn silent_connections_lock_nobody_out() {
    let world = World::new("silent");
    let mut watcher = world.stream();
    assert_eq!(next(&mut watcher)["type"], "snapshot");
    // More than are allowed at the same time; none says a word.
    let mut silent: Vec<_> = (0..300)
        .map(|_| TcpStream::connect(world.site.0).unwrap())
        .collect();
    assert_eq!(world.site.get("/api/v1/robots")["robots"], json!(["r"]));
    // The first one had to make room.
    assert_eq!(silent[0].read(&mut [0]).unwrap_or(0), 0);
    // Those that are left have some seconds for a request, and are closed then.
    assert_eq!(silent[299].read(&mut [0]).unwrap_or(0), 0);
    // Whoever watches is not silent: it was not its turn.
    world.answer(1, 1.0);
    while next(&mut watcher)["type"] != "answer" {}
}

#[test]
fn the_field_flows_while_somebody_looks() {
    let world = World::new("field");
    let fields = world.graph.publisher::<topic::Field>().unwrap();
    assert!(!fields.has_subscribers());
    let mut socket = world.stream();
    socket
        .send(Message::text(
            json!({"type": "field", "on": true}).to_string(),
        ))
        .unwrap();
    let tick = std::time::Duration::from_millis(20);
    let wait = |wanted: bool| {
        world
            .graph
            .run(&[], tick, |_| {
                let reached = fields.has_subscribers() == wanted;
                Ok::<_, TransportError>(if reached { Flow::Stop } else { Flow::Continue })
            })
            .unwrap();
    };
    wait(true);
    let mut loan = fields.loan(2).unwrap();
    *loan.header_mut() = FieldHeader {
        width: 2,
        height: 1,
        best: 10,
        ..FieldHeader::zeroed()
    };
    loan.items_mut().copy_from_slice(&[10, 0]);
    loan.send().unwrap();
    let image = loop {
        if let Message::Binary(image) = socket.read().unwrap() {
            break image;
        }
    };
    assert_eq!(image[image.len() - 2..], [255, 0]);
    drop(socket);
    wait(false);
}

#[test]
fn writing_needs_the_token_and_somebody_who_listens() {
    let world = World::new("token");
    let path = "/api/v1/robots/r/region";
    let body = r#"{"corners":[[0,0],[2,3]]}"#;
    let json = "Content-Type: application/json";
    let token = format!("Authorization: Bearer {TOKEN}");
    let put = |headers: &[&str], body: &str| world.site.ask("PUT", path, headers, body).0;
    assert_eq!(put(&[json], body), 401);
    assert_eq!(
        put(&[json, "Authorization: Bearer 0123456789abcdeX"], body),
        403
    );
    assert_eq!(
        put(&[json, "Authorization: Basic 0123456789abcdef"], body),
        401
    );
    assert_eq!(put(&[json, &token], body), 409, "nobody takes a region");
    assert_eq!(
        world
            .site
            .ask("POST", "/api/v1/robots/r/save", &[&token], "")
            .0,
        409
    );

    let regions = world.graph.subscriber::<topic::Region>().unwrap();
    let saves = world.graph.subscriber::<topic::Save>().unwrap();
    world.wait_for_state(|known| known["abilities"] == json!({"region": true, "save": true}));
    assert_eq!(put(&[json, &token], body), 202);
    let corners = wait_for(&world.graph, &regions, |_, corners| {
        (!corners.is_empty()).then(|| corners.to_vec())
    });
    assert_eq!(
        corners,
        [Corner { x: 0.0, y: 0.0 }, Corner { x: 2.0, y: 3.0 }]
    );
    let known = world.wait_for_state(|known| known["region"] != json!([]));
    assert_eq!(known["region"], json!([[0.0, 0.0], [2.0, 3.0]]));
    assert_eq!(world.site.ask("DELETE", path, &[&token], "").0, 202);
    wait_for(&world.graph, &regions, |_, corners| {
        corners.is_empty().then_some(())
    });
    assert_eq!(
        world
            .site
            .ask("POST", "/api/v1/robots/r/save", &[&token], "")
            .0,
        202
    );
    wait_for(&world.graph, &saves, |_, _| Some(()));
}

#[test]
fn nonsense_is_refused_with_a_reason() {
    let world = World::new("nonsense");
    let regions = world.graph.subscriber::<topic::Region>().unwrap();
    world.wait_for_state(|known| known["abilities"]["region"] == true);
    let token = format!("Authorization: Bearer {TOKEN}");
    let headers = [token.as_str(), "Content-Type: application/json"];
    let put = |body: &str| {
        world
            .site
            .ask("PUT", "/api/v1/robots/r/region", &headers, body)
            .0
    };
    assert_eq!(put("{"), 400);
    assert_eq!(put(r#"{"corners":[[0,0],[1,1]],"more":1}"#), 422);
    assert_eq!(put(r#"{"corners":[[0,0]]}"#), 422);
    assert_eq!(put(r#"{"corners":[[0,0],[1e300,1]]}"#), 422);
    assert_eq!(put(r#"{"corners":[[0,0],[null,1]]}"#), 422);
    let many = format!(r#"{{"corners":[{}[0,0]]}}"#, "[0,0],".repeat(1000));
    assert_eq!(put(&many), 422);
    assert_eq!(
        put(&format!(
            r#"{{"corners":[{}[0,0]]}}"#,
            "[0,0],".repeat(100_000)
        )),
        413
    );
    let sent = regions.newest().unwrap();
    assert!(sent.is_none_or(|sent| sent.items().is_empty()), "no region");
    let (status, body) = world.site.ask("GET", "/api/v1/robots/other", &[], "");
    assert_eq!(status, 404);
    assert!(body.contains("there is no robot"), "{body}");
    assert_eq!(world.site.ask("GET", "/../etc/passwd", &[], "").0, 404);
    assert_eq!(world.site.ask("POST", "/", &[], "").0, 405);
}

#[test]
fn other_sites_are_refused() {
    let world = World::new("sites");
    let ask = |headers: &[&str]| world.site.ask("GET", "/api/v1/robots", headers, "").0;
    assert_eq!(ask(&["Origin: http://evil.example"]), 403);
    assert_eq!(ask(&["Origin: null"]), 403);
    assert_eq!(ask(&[&format!("Origin: http://{}", world.site.0)]), 200);
    assert_eq!(ask(&["Host: evil.example"]), 421);
    assert_eq!(ask(&["Sec-Fetch-Site: cross-site"]), 403);
    // A WebSocket is not kept from other sites by browsers.
    let upgrade = [
        "Connection: Upgrade",
        "Upgrade: websocket",
        "Sec-WebSocket-Version: 13",
        "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==",
        "Origin: http://evil.example",
    ];
    let (status, _) = world
        .site
        .ask("GET", "/api/v1/robots/r/stream", &upgrade, "");
    assert_eq!(status, 403);
    let (_, head, _) = world.site.raw(
        format!(
            "GET / HTTP/1.1\r\nHost: {}\r\nConnection: close\r\n\r\n",
            world.site.0
        )
        .as_bytes(),
    );
    assert!(
        head.contains("content-security-policy: default-src 'none'"),
        "{head}"
    );
}

#[test]
fn hostile_sizes_end_the_connection_and_nothing_else() {
    let world = World::new("hostile");
    let mut socket = world.stream();
    next(&mut socket);
    // More than a message to the monitor may have.
    let sent = socket.send(Message::text("x".repeat(1 << 20)));
    let ended =
        sent.is_err() || std::iter::from_fn(|| Some(socket.read())).any(|read| read.is_err());
    assert!(ended);
    let mut socket = world.stream();
    socket.send(Message::text("{\"type\":\"reboot\"}")).unwrap();
    let closed = loop {
        if let Message::Close(frame) = socket.read().unwrap() {
            break frame.unwrap();
        }
    };
    assert_eq!(u16::from(closed.code), 1008);
    assert!(closed.reason.contains("reboot"), "{}", closed.reason);
    // A head without end is cut off, and garbage is no request.
    let head = format!(
        "GET / HTTP/1.1\r\nHost: x\r\nX: {}\r\n\r\n",
        "x".repeat(1 << 20)
    );
    assert!((400..500).contains(&world.site.raw(head.as_bytes()).0));
    assert_eq!(world.site.raw(b"\x16\x03\x01 hello\r\n\r\n").0, 400);
    assert_eq!(world.site.get("/api/v1/robots")["robots"], json!(["r"]));
}

#[test]
fn as_many_watch_as_may() {
    let world = World::new("many");
    let sockets: Vec<_> = (0..64).map(|_| world.stream()).collect();
    let url = format!("ws://{}/api/v1/robots/r/stream", world.site.0);
    let refused = client(url, TcpStream::connect(world.site.0).unwrap());
    assert!(refused.is_err(), "the 65th is refused");
    drop(sockets);
}
