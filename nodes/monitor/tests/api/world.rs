//! The node in a graph of its own, fed by the test.

use std::net::TcpStream;

use bytemuck::Zeroable;
use messages::{HypothesesHeader, Hypothesis, Pose2, PoseHeader, TrackState, Verdict, topic};
use serde_json::Value;
use tempfile::TempDir;
use tests::drawn_map::DrawnMap;
use tests::http::{Site, token_file};
use transport::testing::{Isolated, NodeProcess, StoppedAtEnd, wait_to_see, wait_until_ready};
use transport::{Graph, Publisher};
use tungstenite::{Message, WebSocket, client};

pub(crate) const TOKEN: &str = "0123456789abcdef";

/// Returns the map id as written by the API.
pub(crate) fn map_name() -> String {
    format!("{:016x}", DrawnMap::small().header.map_id)
}

pub(crate) struct World {
    _node: StoppedAtEnd,
    pub(crate) site: Site,
    hypotheses: Publisher<topic::Hypotheses>,
    pub(crate) poses: Publisher<topic::Tracked>,
    pub(crate) beams: Publisher<topic::Beams>,
    _maps: Publisher<topic::Map>,
    pub(crate) graph: Graph,
    _isolated: Isolated,
    _folder: TempDir,
}

impl World {
    pub(crate) fn new(test: &str) -> World {
        World::with(test, &[])
    }

    pub(crate) fn with(test: &str, more: &[&str]) -> World {
        let isolated = Isolated::new(test);
        let graph = isolated.join("test");
        let folder = tempfile::tempdir().unwrap();
        let token = token_file(folder.path(), TOKEN);
        let site = Site::free();
        let maps = graph.publisher().unwrap();
        DrawnMap::small().send(&maps);
        let (address, token) = (site.0.to_string(), token.to_str().unwrap());
        let common = ["--listen", &address, "--robot", "r", "--token-file", token];
        let arguments = [&common, more].concat();
        let node = NodeProcess::start(env!("CARGO_BIN_EXE_monitor"), &graph, arguments);
        wait_until_ready(&graph, "monitor");
        World {
            _node: node.into(),
            site,
            hypotheses: graph.publisher().unwrap(),
            poses: graph.publisher().unwrap(),
            beams: graph.publisher().unwrap(),
            _maps: maps,
            graph,
            _isolated: isolated,
            _folder: folder,
        }
    }

    pub(crate) fn answer(&self, counter: u64, x: f64) {
        let mut header = HypothesesHeader {
            map_id: DrawnMap::small().header.map_id,
            verdict: Verdict::Unique as u32,
            ..HypothesesHeader::zeroed()
        };
        header.stamp.counter = counter;
        let place = Hypothesis {
            map_from_laser: at(x),
            ..Hypothesis::zeroed()
        };
        self.hypotheses.send(header, &[place]).unwrap();
    }

    /// Publishes a pose of the tracker, from a scan that arrived `age_s` seconds ago.
    pub(crate) fn track(&self, counter: u64, state: TrackState, x: f64, age_s: i64) {
        let mut header = PoseHeader {
            map_id: DrawnMap::small().header.map_id,
            sent_ns: transport::monotonic_ns(),
            map_from_laser: at(x),
            state: state as u32,
            from_scan: 1,
            pose_known: 1,
            ..PoseHeader::zeroed()
        };
        header.stamp.counter = counter;
        header.stamp.entered_ns = header.sent_ns - age_s * 1_000_000_000;
        // A message is not sent before its measurement.
        header.sent_ns = header.sent_ns.max(header.stamp.entered_ns);
        self.poses.send(header, b"one place is left").unwrap();
    }

    /// Repeats the request until the answer satisfies `is_awaited`; the graph keeps running.
    pub(crate) fn wait_for_state(&self, is_awaited: impl Fn(&Value) -> bool) -> Value {
        wait_to_see(&self.graph, || {
            Some(self.site.get("/api/v1/robots/r")).filter(&is_awaited)
        })
    }

    pub(crate) fn stream(&self) -> WebSocket<TcpStream> {
        let url = format!("ws://{}/api/v1/robots/r/stream", self.site.0);
        let stream = TcpStream::connect(self.site.0).unwrap();
        client(url, stream).unwrap().0
    }
}

fn at(x: f64) -> Pose2 {
    let (y, yaw) = (2.0, 0.5);
    Pose2 { x, y, yaw }
}

pub(crate) fn next(socket: &mut WebSocket<TcpStream>) -> Value {
    loop {
        if let Message::Text(text) = socket.read().unwrap() {
            return serde_json::from_str(&text).unwrap();
        }
    }
}

pub(crate) fn next_of(socket: &mut WebSocket<TcpStream>, kind: &str) -> Value {
    loop {
        let message = next(socket);
        if message["type"] == kind {
            return message;
        }
    }
}
