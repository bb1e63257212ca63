//! Tests with a viewer of Foxglove's protocol, over TCP, and a graph behind the server.
#![allow(clippy::unwrap_used, reason = "the lint spares test functions alone")]

use std::collections::BTreeMap;
use std::net::TcpStream;

use bytemuck::Zeroable;
use messages::{
    FieldHeader, FrameName, HypothesesHeader, Hypothesis, Pose2, ScanHeader, Stamp, Verdict, topic,
};
use ros::{LaserScan, OccupancyGridMsg, PoseWithCovarianceStamped};
use serde::de::DeserializeOwned;
use serde_json::{Value, json};
use tests::drawn_map::DrawnMap;
use tests::http::Site;
use transport::testing::{
    Isolated, NodeProcess, StoppedAtEnd, wait_for_health, wait_to_see, wait_until, wait_until_ready,
};
use transport::{Graph, Publisher, monotonic_ns};
use tungstenite::client::IntoClientRequest;
use tungstenite::http::HeaderValue;
use tungstenite::{Message, WebSocket, client};

const SECOND: i64 = 1_000_000_000;
/// Time of the first scan.
const START: i64 = 1_137_772_793 * SECOND;

/// The node in a graph of its own, fed by the test.
struct World {
    _node: StoppedAtEnd,
    site: Site,
    maps: Publisher<topic::Map>,
    scans: Publisher<topic::Scan>,
    hypotheses: Publisher<topic::Hypotheses>,
    fields: Publisher<topic::Field>,
    graph: Graph,
    _isolated: Isolated,
}

impl World {
    fn new(test: &str) -> Self {
        let isolated = Isolated::new(test);
        let graph = isolated.join("test");
        let site = Site::free();
        let listen = site.0.to_string();
        // With few file descriptors, so that a test can use them up.
        let limited = ["-c", "ulimit -n 512 && exec \"$@\"", "sh"];
        let node = env!("CARGO_BIN_EXE_foxglove_server");
        let arguments = [node, "--listen", &listen, "--robot", "r7"];
        let node = NodeProcess::start("sh", &graph, limited.iter().chain(&arguments));
        wait_until_ready(&graph, "foxglove_server");
        World {
            _node: node.into(),
            site,
            maps: graph.publisher().unwrap(),
            scans: graph.publisher().unwrap(),
            hypotheses: graph.publisher().unwrap(),
            fields: graph.publisher().unwrap(),
            graph,
            _isolated: isolated,
        }
    }

    fn stamp(counter: u64) -> Stamp {
        Stamp {
            measured_ns: START + counter.cast_signed() * SECOND,
            entered_ns: monotonic_ns(),
            counter,
        }
    }

    fn send_scan(&self, counter: u64) {
        let header = ScanHeader {
            stamp: Self::stamp(counter),
            angle_increment: 0.5,
            range_max_m: 30.0,
            mount_known: 1,
            frame: FrameName::new("laser"),
            ..ScanHeader::zeroed()
        };
        self.scans.send(header, &[1.5, counter as f32]).unwrap();
    }

    fn answer(&self, counter: u64, x: f64) {
        let header = HypothesesHeader {
            stamp: Self::stamp(counter),
            map_id: DrawnMap::small().header.map_id,
            verdict: Verdict::Unique as u32,
            mount_known: 1,
            ..HypothesesHeader::zeroed()
        };
        let place = Hypothesis {
            map_from_base: Pose2 {
                x,
                y: 2.0,
                yaw: 0.5,
            },
            ..Hypothesis::zeroed()
        };
        self.hypotheses.send(header, &[place]).unwrap();
    }

    fn send_field(&self) {
        let header = FieldHeader {
            stamp: Self::stamp(0),
            map_id: DrawnMap::small().header.map_id,
            width: 2,
            height: 1,
            block: 2,
            highest_possible: 200,
            ..FieldHeader::zeroed()
        };
        self.fields.send(header, &[0, 100]).unwrap();
    }

    /// Waits until the image has subscribers, or none.
    fn wait_for_looks(&self, wanted: bool) {
        wait_to_see(&self.graph, || {
            (self.fields.has_subscribers() == wanted).then_some(())
        });
    }
}

/// Client of the protocol `foxglove.sdk.v1`.
struct Viewer {
    socket: WebSocket<TcpStream>,
    server: Value,
    /// Advertised channels, by topic.
    channels: BTreeMap<String, Value>,
    /// Topics, by subscription id.
    subscribed: BTreeMap<u32, String>,
}

/// Message received by a viewer.
struct Shown {
    topic: String,
    log_time_ns: u64,
    body: Vec<u8>,
}

impl Viewer {
    fn connect(site: Site) -> Self {
        let mut viewer = Viewer {
            socket: Self::speak(site, "foxglove.sdk.v1").unwrap(),
            server: Value::Null,
            channels: BTreeMap::new(),
            subscribed: BTreeMap::new(),
        };
        while viewer.server.is_null() {
            assert!(viewer.receive().is_none());
        }
        viewer
    }

    /// Opens a WebSocket for a protocol, or returns why it was refused.
    fn speak(site: Site, protocol: &'static str) -> Result<WebSocket<TcpStream>, String> {
        let mut request = format!("ws://{}/", site.0).into_client_request().unwrap();
        let protocol = HeaderValue::from_static(protocol);
        request
            .headers_mut()
            .insert("sec-websocket-protocol", protocol);
        let stream = TcpStream::connect(site.0).unwrap();
        let opened = client(request, stream);
        let (socket, _) = opened.map_err(|error| error.to_string())?;
        Ok(socket)
    }

    /// Reads one message of the server: data of a channel, or a notice, which is stored.
    fn receive(&mut self) -> Option<Shown> {
        match self.socket.read().unwrap() {
            Message::Text(text) => {
                let said: Value = serde_json::from_str(&text).unwrap();
                match said["op"].as_str().unwrap() {
                    "serverInfo" => self.server = said,
                    "advertise" => {
                        for channel in said["channels"].as_array().unwrap() {
                            let topic = channel["topic"].as_str().unwrap().to_owned();
                            self.channels.insert(topic, channel.clone());
                        }
                    }
                    other => panic!("{other}: {said}"),
                }
                None
            }
            // Message data: 1, the subscription id, the time, the message.
            Message::Binary(bytes) if bytes[0] == 1 => {
                let subscription = u32::from_le_bytes(bytes[1..5].try_into().unwrap());
                Some(Shown {
                    topic: self.subscribed[&subscription].clone(),
                    log_time_ns: u64::from_le_bytes(bytes[5..13].try_into().unwrap()),
                    body: bytes[13..].to_vec(),
                })
            }
            other => panic!("{other:?}"),
        }
    }

    /// Subscribes to a topic once it is advertised.
    fn subscribe(&mut self, topic: &str) {
        while !self.channels.contains_key(topic) {
            assert!(self.receive().is_none_or(|shown| shown.topic != topic));
        }
        let number = self.subscribed.len() as u32 + 1;
        self.subscribed.insert(number, topic.to_owned());
        let request = json!({
            "op": "subscribe",
            "subscriptions": [{"id": number, "channelId": self.channels[topic]["id"]}],
        });
        self.socket
            .send(Message::text(request.to_string()))
            .unwrap();
    }

    /// Waits for the next message of a topic.
    fn next(&mut self, topic: &str) -> Shown {
        loop {
            if let Some(shown) = self.receive().filter(|shown| shown.topic == topic) {
                return shown;
            }
        }
    }
}

fn decoded<M: DeserializeOwned>(shown: &Shown) -> M {
    ros::cdr::decode(&shown.body).unwrap()
}

#[test]
fn a_viewer_sees_scans_and_poses_at_their_times() {
    let world = World::new("fox-live");
    world.send_scan(0);
    let mut viewer = Viewer::connect(world.site);
    assert_eq!(viewer.server["name"], "r7");
    assert_eq!(
        viewer.server["capabilities"],
        json!([]),
        "it receives nothing"
    );
    viewer.subscribe("/scan");
    let channel = &viewer.channels["/scan"];
    assert_eq!(channel["schemaName"], "sensor_msgs/msg/LaserScan");
    assert_eq!(
        (&channel["encoding"], &channel["schemaEncoding"]),
        (&json!("cdr"), &json!("ros2msg"))
    );
    let definition = channel["schema"].as_str().unwrap();
    assert!(definition.contains("float32[] ranges"), "{definition}");
    world.answer(0, 1.5);
    viewer.subscribe("/pose");
    // Requests are processed in order, and a latched message is sent at once.
    viewer.subscribe("/tf_static");
    viewer.next("/tf_static");
    for counter in 1..=3 {
        let at_ns = (START + counter * SECOND).cast_unsigned();
        world.send_scan(counter.cast_unsigned());
        let shown = viewer.next("/scan");
        let scan: LaserScan = decoded(&shown);
        assert_eq!(scan.ranges, [1.5, counter as f32]);
        assert_eq!(shown.log_time_ns, at_ns);
        world.answer(counter.cast_unsigned(), 1.5 + counter as f64);
        let shown = viewer.next("/pose");
        let pose: PoseWithCovarianceStamped = decoded(&shown);
        let position = pose.pose.pose.position;
        assert_eq!((position.x, position.y), (1.5 + counter as f64, 2.0));
        assert_eq!(shown.log_time_ns, at_ns);
    }
}

#[test]
fn who_comes_late_gets_the_map_and_the_mount() {
    let world = World::new("fox-late");
    DrawnMap::small().send(&world.maps);
    world.send_scan(0);
    for _ in 0..2 {
        let mut viewer = Viewer::connect(world.site);
        viewer.subscribe("/map");
        let map: OccupancyGridMsg = decoded(&viewer.next("/map"));
        assert_eq!((map.info.width, map.info.height), (3, 2));
        assert_eq!(map.data, [0, 100, -1, 0, 0, 100]);
        viewer.subscribe("/tf_static");
        assert_eq!(viewer.next("/tf_static").log_time_ns, START.cast_unsigned());
    }
}

#[test]
fn the_image_is_computed_while_somebody_looks_and_strangers_do_no_harm() {
    let world = World::new("fox-field");
    let health = world.graph.subscriber::<topic::Health>().unwrap();
    DrawnMap::small().send(&world.maps);
    world.send_scan(0);
    assert!(!world.fields.has_subscribers());
    let mut viewer = Viewer::connect(world.site);
    viewer.subscribe("/field");
    world.wait_for_looks(true);
    world.send_field();
    let image: OccupancyGridMsg = decoded(&viewer.next("/field"));
    assert_eq!(image.data, [0, 50]);
    drop(viewer);
    world.wait_for_looks(false);
    // A client with another protocol is refused, and invalid messages do no harm.
    let refused = Viewer::speak(world.site, "mqtt").unwrap_err();
    assert!(refused.contains("400"), "{refused}");
    let mut stranger = Viewer::connect(world.site);
    for nonsense in ["", "{", r#"{"op": "subscribe", "subscriptions": 7}"#, "[]"] {
        stranger.socket.send(Message::text(nonsense)).unwrap();
    }
    stranger
        .socket
        .send(Message::binary(vec![255; 70]))
        .unwrap();
    drop(stranger);
    // A scan whose time does not fit into ROS is refused and counted.
    let mut header = ScanHeader::zeroed();
    header.stamp.measured_ns = -1;
    world.scans.send(header, &[]).unwrap();
    let (_, error) = wait_for_health(&world.graph, &health, |report| {
        report.node.as_str() == "foxglove_server" && report.refused == 1
    });
    assert!(error.starts_with("topic scan: a stamp of -1 ns"), "{error}");
    let mut viewer = Viewer::connect(world.site);
    viewer.subscribe("/map");
    viewer.next("/map");
}

#[test]
fn silent_connections_lock_nobody_out_and_delay_no_end() {
    let world = World::new("fox-silent");
    let health = world.graph.subscriber::<topic::Health>().unwrap();
    DrawnMap::small().send(&world.maps);
    world.send_scan(0);
    // More than the node has file descriptors; those that cannot be accepted wait in the system.
    let silent: Vec<_> = (0..600)
        .map_while(|_| TcpStream::connect(world.site.0).ok())
        .collect();
    wait_until(&world.graph, &health, |_, error| {
        error.starts_with(b"too many connections")
    });
    drop(silent);
    let mut viewer = Viewer::connect(world.site);
    viewer.subscribe("/map");
    viewer.next("/map");
    // It is still there when the node is stopped.
    let _silent = TcpStream::connect(world.site.0).unwrap();
    drop((health, world));
}
