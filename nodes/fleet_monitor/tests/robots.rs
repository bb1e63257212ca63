//! Tests with several robots on one page, received over a network, and unknown senders of invalid
//! data.
#![allow(clippy::unwrap_used, reason = "the lint spares test functions alone")]

use bytemuck::Zeroable;
use messages::{
    Corner, HypothesesHeader, Hypothesis, Pose2, PoseHeader, RegionHeader, TrackState, Verdict,
    topic,
};
use network_payload::{Preamble, Wire};
use serde_json::{Value, json};
use tempfile::TempDir;
use tests::browser::Browser;
use tests::drawn_map::DrawnMap;
use tests::http::{Site, token_file};
use transport::testing::{
    Isolated, NodeProcess, StoppedAtEnd, wait_for_health, wait_to_see, wait_until_ready,
};
use transport::{Graph, monotonic_ns};
use zenoh::bytes::Encoding;
use zenoh::qos::CongestionControl;
use zenoh::time::Timestamp;
use zenoh::{Session, Wait};
use zenoh_ext::{AdvancedPublisher, AdvancedPublisherBuilderExt, AdvancedSubscriberBuilderExt};
use zenoh_ext::{CacheConfig, HistoryConfig, MissDetectionConfig};
use zenoh_session::testing::client;

const TOKEN: &str = "0123456789abcdef";

/// The node, its page, and the address for robots.
struct World {
    _node: StoppedAtEnd,
    site: Site,
    endpoint: String,
    graph: Graph,
    _isolated: Isolated,
    _folder: TempDir,
}

impl World {
    fn new(test: &str) -> Self {
        let isolated = Isolated::new(test);
        let graph = isolated.join("test");
        let folder = tempfile::tempdir().unwrap();
        let token = token_file(folder.path(), TOKEN);
        let (site, endpoint) = (
            Site::free(),
            format!("tcp/{}:7447", isolated.name().loopback()),
        );
        let (page, token) = (site.0.to_string(), token.to_str().unwrap());
        let arguments = [
            "--page",
            &page,
            "--token-file",
            token,
            "--listen",
            &endpoint,
        ];
        let node = NodeProcess::start(env!("CARGO_BIN_EXE_fleet_monitor"), &graph, arguments);
        wait_until_ready(&graph, "fleet_monitor");
        World {
            _node: node.into(),
            site,
            endpoint,
            graph,
            _isolated: isolated,
            _folder: folder,
        }
    }

    /// Repeats the request until the answer satisfies `is_awaited`.
    fn wait_for(&self, path: &str, is_awaited: impl Fn(&Value) -> bool) -> Value {
        wait_to_see(&self.graph, || {
            let (status, body) = self.site.ask("GET", path, &[], "");
            let answer = (status == 200).then(|| serde_json::from_str(&body).unwrap());
            answer.filter(&is_awaited)
        })
    }

    fn robot(&self, name: &str) -> FarRobot {
        FarRobot {
            name: name.to_owned(),
            session: client(&self.endpoint),
        }
    }
}

/// Simulated bridge of a robot.
struct FarRobot {
    name: String,
    session: Session,
}

impl FarRobot {
    fn payload<T: Wire>(sequence: u64, header: &T::Header, items: &[T::Item]) -> Vec<u8> {
        let preamble = Preamble {
            sender: 7,
            sequence,
            clock_ns: monotonic_ns(),
        };
        network_payload::encode::<T>(&preamble, header, items).unwrap()
    }

    fn put(&self, time: Option<Timestamp>, key: &str, encoding: &str, payload: Vec<u8>) {
        let put = self.session.put(key, payload).timestamp(time);
        let put = put.encoding(Encoding::from(encoding));
        put.congestion_control(CongestionControl::Block)
            .wait()
            .unwrap();
    }

    /// Sends a message on the robot's topic, with this Zenoh timestamp.
    fn send<T: Wire>(
        &self,
        time: Option<Timestamp>,
        sequence: u64,
        header: &T::Header,
        items: &[T::Item],
    ) {
        let key = network_payload::key::<T>(&self.name);
        let payload = Self::payload::<T>(sequence, header, items);
        self.put(time, &key, &network_payload::encoding::<T>(), payload);
    }

    fn answer(&self, sequence: u64, x: f64) {
        self.answer_at(None, sequence, x);
    }

    /// Sends a place in a message with this Zenoh timestamp.
    fn answer_at(&self, time: Option<Timestamp>, sequence: u64, x: f64) {
        let mut header = HypothesesHeader {
            verdict: Verdict::Unique as u32,
            ..HypothesesHeader::zeroed()
        };
        header.stamp.counter = sequence;
        header.stamp.entered_ns = monotonic_ns();
        header.sent_ns = monotonic_ns();
        let place = Hypothesis {
            map_from_laser: Pose2 {
                x,
                y: 2.0,
                yaw: 0.5,
            },
            ..Hypothesis::zeroed()
        };
        self.send::<topic::Hypotheses>(time, sequence, &header, &[place]);
    }

    /// Sends a pose of the tracker.
    fn track(&self, sequence: u64, x: f64) {
        let mut header = PoseHeader {
            state: TrackState::Doubtful as u32,
            pose_known: 1,
            from_scan: 1,
            ..PoseHeader::zeroed()
        };
        header.stamp.entered_ns = monotonic_ns();
        header.sent_ns = monotonic_ns();
        header.map_from_laser.x = x;
        self.send::<topic::Tracked>(None, sequence, &header, b"the scans do not fit");
    }

    /// Publishes a map that is kept for late joiners.
    fn serve_map(&self) -> AdvancedPublisher<'static> {
        let publisher = self
            .session
            .declare_publisher(network_payload::key::<topic::Map>(&self.name))
            .encoding(Encoding::from(network_payload::encoding::<topic::Map>()))
            .cache(CacheConfig::default().max_samples(1))
            // As in bridges: otherwise each message would need a time of Zenoh's clock.
            .sample_miss_detection(MissDetectionConfig::default())
            .publisher_detection()
            .wait()
            .unwrap();
        let DrawnMap { header, cells } = DrawnMap::small();
        let payload = Self::payload::<topic::Map>(0, &header, &cells);
        publisher.put(payload).wait().unwrap();
        publisher
    }
}

#[test]
fn robots_come_with_what_they_say_and_stay_apart() {
    let world = World::new("fleet-apart");
    assert_eq!(world.site.get("/api/v1/robots")["robots"], json!([]));
    let (a, b) = (world.robot("a"), world.robot("b"));
    let _map = a.serve_map();
    a.answer(0, 1.5);
    b.answer(0, 9.0);
    world.wait_for("/api/v1/robots", |known| {
        known["robots"] == json!(["a", "b"])
    });
    let x = |robot: &str, x: f64| {
        let path = format!("/api/v1/robots/{robot}");
        world.wait_for(&path, |known| {
            known["answer"]["hypotheses"][0]["laser"]["x"] == x
        })
    };
    x("a", 1.5);
    x("b", 9.0);
    b.answer(1, 9.5);
    x("b", 9.5);
    let known = world.wait_for("/api/v1/robots/a", |known| known["map"]["width"] == 3);
    assert_eq!(known["answer"]["hypotheses"][0]["laser"]["x"], 1.5);
    assert_eq!(world.site.get("/api/v1/robots/b")["map"], Value::Null);
    a.track(0, 2.5);
    let known = world.wait_for("/api/v1/robots/a", |known| {
        known["pose"]["laser"]["x"] == 2.5
    });
    assert_eq!(known["pose"]["state"], "Doubtful");
    assert_eq!(known["pose"]["says"], "the scans do not fit");
}

/// The router that robots send through assigns increasing times, but messages may overtake each
/// other there.
#[test]
fn a_robot_is_received_whose_message_was_overtaken_by_anothers() {
    let world = World::new("fleet-times");
    let (a, b) = (world.robot("a"), world.robot("b"));
    let (earlier, later) = (a.session.new_timestamp(), a.session.new_timestamp());
    assert!(earlier < later);
    b.answer_at(Some(later), 0, 9.0);
    world.wait_for("/api/v1/robots", |known| known["robots"] == json!(["b"]));
    a.answer_at(Some(earlier), 0, 1.5);
    world.wait_for("/api/v1/robots", |known| {
        known["robots"] == json!(["a", "b"])
    });
}

#[test]
fn a_region_reaches_the_robot_that_it_was_set_for() {
    let world = World::new("fleet-region");
    let (a, b) = (world.robot("a"), world.robot("b"));
    a.answer(0, 1.0);
    b.answer(0, 1.0);
    let listen = |robot: &FarRobot| {
        let history = HistoryConfig::default().detect_late_publishers();
        let subscriber = robot
            .session
            .declare_subscriber(network_payload::key::<topic::Region>(&robot.name));
        subscriber.history(history).wait().unwrap()
    };
    let (received, others) = (listen(&a), listen(&b));
    world.wait_for("/api/v1/robots/a", |known| {
        known["abilities"]["region"] == true
    });
    let path = "/api/v1/robots/a/region";
    let headers = [
        "Content-Type: application/json",
        &format!("Authorization: Bearer {TOKEN}"),
    ];
    let body = r#"{"corners":[[0,0],[2,1]]}"#;
    assert_eq!(world.site.ask("PUT", path, &headers[..1], body).0, 401);
    assert_eq!(world.site.ask("PUT", path, &headers, body).0, 202);
    let sample = received.recv().unwrap();
    let encoding = sample.encoding().to_string();
    let region =
        network_payload::decode::<topic::Region>(&encoding, &sample.payload().to_bytes()).unwrap();
    let RegionHeader { stamp } = region.header;
    assert!(stamp.entered_ns > 0);
    assert_eq!(
        region.items,
        [Corner { x: 0.0, y: 0.0 }, Corner { x: 2.0, y: 1.0 }]
    );
    assert!(others.try_recv().unwrap().is_none(), "it is not b's");
    // No recorder keeps the last minutes there.
    let save = "/api/v1/robots/a/save";
    assert_eq!(world.site.ask("POST", save, &headers[1..], "").0, 409);
}

#[test]
fn what_strangers_send_is_refused_and_counted() {
    let world = World::new("fleet-hostile");
    let health = world.graph.subscriber::<topic::Health>().unwrap();
    let stranger = world.robot("a");
    stranger.answer(0, 1.0);
    let sound = network_payload::encoding::<topic::Hypotheses>();
    let key = network_payload::key::<topic::Hypotheses>("a");
    stranger.put(None, &key, &sound, vec![0xff; 100]);
    stranger.put(None, &key, "text/plain", b"hello".to_vec());
    stranger.put(None, &key, &sound, vec![0; 2 << 20]);
    stranger.put(None, "backcast/a b/hypotheses", &sound, vec![0]);
    // More robots than can be shown, each valid by itself.
    for i in 0..300 {
        let robot = FarRobot {
            name: format!("r{i}"),
            session: stranger.session.clone(),
        };
        robot.answer(0, 1.0);
    }
    wait_for_health(&world.graph, &health, |report| {
        report.node.as_str() == "fleet_monitor" && report.refused == 4 + 45
    });
    let known = world.site.get("/api/v1/robots");
    assert_eq!(known["robots"].as_array().unwrap().len(), 256);
    stranger.answer(1, 3.0);
    world.wait_for("/api/v1/robots/a", |known| {
        known["answer"]["hypotheses"][0]["laser"]["x"] == 3.0
    });
}

#[test]
fn the_page_lets_people_choose_a_robot() {
    let test = "the_page_lets_people_choose_a_robot";
    let Some(browser) = Browser::open(test, 1280, 800) else {
        return;
    };
    let world = World::new("fleet-choose");
    let (a, b) = (world.robot("a"), world.robot("b"));
    a.track(0, 1.5);
    b.track(0, 9.0);
    world.wait_for("/api/v1/robots", |known| {
        known["robots"] == json!(["a", "b"])
    });
    let shows = |robot: &str, x: &str| {
        browser.wait_until(&format!(
            "document.getElementById('pose-x').textContent === '{x}'
             && document.getElementById('robot').value === '{robot}'
             && document.title.includes(' · {robot} · ')"
        ));
    };
    browser.visit(&format!("http://{}/?robot=b", world.site.0));
    shows("b", "9.00");
    let _ = browser.run(
        "const list = document.getElementById('robot');
         list.value = 'a';
         list.dispatchEvent(new Event('change'))",
    );
    shows("a", "1.50");
}
