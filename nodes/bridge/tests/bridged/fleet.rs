//! The router of a fleet and its access rules. The tests use the shipped configurations with other
//! addresses and paths.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Duration;

use messages::topic;
use tempfile::TempDir;
use tests::drawn_map::DrawnMap;
use transport::Graph;
use transport::testing::{Isolated, NodeProcess, wait_for_health, wait_until_ready};
use zenoh::handlers::FifoChannelHandler;
use zenoh::pubsub::Subscriber;
use zenoh::sample::Sample;
use zenoh::{Session, Wait};
use zenoh_ext::{AdvancedSubscriberBuilderExt, HistoryConfig};

/// Log filter that shows messages rejected by an access rule.
const INTERCEPTOR: &str = ",zenoh::net::routing::interceptor=trace";

/// Certificates and configurations of a fleet with this router address.
struct Papers {
    folder: TempDir,
    address: String,
}

fn shipped(file: &str) -> PathBuf {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    root.join("../../docs/zenoh").join(file)
}

fn make_certificates(folder: &Path, names: &[&str]) {
    let mut command = Command::new(shipped("make_test_ca"));
    let status = command.arg(folder).args(names).status().unwrap();
    assert!(status.success(), "is openssl installed?");
}

impl Papers {
    fn new(address: String) -> Self {
        let folder = tempfile::tempdir().unwrap();
        let router = format!("router={address}");
        let names = [router.as_str(), "r1", "r2", "desk"];
        make_certificates(&folder.path().join("pki"), &names);
        // Certificate of another authority, which the router does not trust.
        make_certificates(&folder.path().join("other"), &["r1"]);
        let users = "r1:one\nr2:two\ndesk:three\n";
        std::fs::write(folder.path().join("pki/users.txt"), users).unwrap();
        Papers { folder, address }
    }

    fn path(&self, file: &str) -> PathBuf {
        self.folder.path().join(file)
    }

    /// Writes a shipped configuration with the paths of this test and a further change.
    fn adapted(&self, file: &str, name: &str, change: impl Fn(String) -> String) -> PathBuf {
        let pki = format!("\"{}/", self.path("pki").display());
        let text = std::fs::read_to_string(shipped(file)).unwrap();
        let path = self.path(name);
        std::fs::write(&path, change(text.replace("\"pki/", &pki))).unwrap();
        path
    }

    fn of_router(&self) -> PathBuf {
        self.adapted("router.json5", "router.json5", |text| {
            text.replace("0.0.0.0", &self.address)
        })
    }

    /// Writes the configuration of a robot with this name and password.
    fn of(&self, name: &str, password: &str) -> PathBuf {
        self.adapted("robot.json5", &format!("{name}.json5"), |text| {
            text.replace("192.168.0.7", &self.address)
                .replace("/r1.", &format!("/{name}."))
                .replace("\"r1\"", &format!("\"{name}\""))
                .replace("change-me-too", password)
        })
    }
}

/// Starts a bridge that sends the map, and waits until it has joined graph and network.
fn bridge(graph: &Graph, papers: &Papers, robot: &str, config: &Path) -> NodeProcess {
    let descriptor = "nodes:
  - {id: laser, path: x, outputs: [map]}
  - {id: bridge, path: y, inputs: {map: laser/map}}
";
    let dataflow = papers.path("dataflow.yaml");
    std::fs::write(&dataflow, descriptor).unwrap();
    let bridge = env!("CARGO_BIN_EXE_bridge");
    let (dataflow, config) = (dataflow.to_str().unwrap(), config.to_str().unwrap());
    let log = format!("RUST_LOG={}{INTERCEPTOR}", zenoh_session::LOG);
    let arguments = [
        log.as_str(),
        bridge,
        "--robot",
        robot,
        "--dataflow",
        dataflow,
        "--config",
        config,
    ];
    let process = NodeProcess::start("env", graph, arguments);
    wait_until_ready(graph, "bridge");
    process
}

struct Fleet {
    papers: Papers,
    router: NodeProcess,
    // Declared last, so that it is dropped after the other fields.
    _isolated: Isolated,
}

impl Fleet {
    fn new(tag: &str) -> Self {
        let isolated = Isolated::new(tag);
        let graph = isolated.join("test");
        let papers = Papers::new(isolated.name().loopback().to_string());
        let router = bridge(&graph, &papers, "router", &papers.of_router());
        Fleet {
            papers,
            router,
            _isolated: isolated,
        }
    }

    /// Stops the router and returns its log.
    fn log(self) -> String {
        self.router.interrupt();
        let (status, log) = self.router.finish();
        assert!(status.success(), "{status}\n{log}");
        log
    }
}

/// Tries to connect once, which is Zenoh's default.
fn connect(config: &Path) -> Result<Session, zenoh::Error> {
    zenoh::open(zenoh::Config::from_file(config).unwrap()).wait()
}

fn subscribe(session: &Session, key: &str) -> Subscriber<FifoChannelHandler<Sample>> {
    session.declare_subscriber(key.to_owned()).wait().unwrap()
}

#[test]
fn who_has_the_wrong_papers_stays_outside() {
    let fleet = Fleet::new("papers");
    let good = fleet.papers.of("r1", "one");
    drop(connect(&good).unwrap());
    let text = std::fs::read_to_string(&good).unwrap();
    let [ours, other] = ["pki/r1.", "other/r1."].map(|file| {
        let path = fleet.papers.path(file);
        path.to_str().unwrap().to_owned()
    });
    let without = |key: &str| {
        let lines = text.lines().filter(|line| !line.contains(key));
        lines.collect::<Vec<_>>().join("\n")
    };
    let bare = without("connect_").replace("enable_mtls: true", "enable_mtls: false");
    let wrong = [
        (
            "another authority's certificate",
            text.replace(&ours, &other),
        ),
        ("no certificate", bare),
        ("another password", text.replace("\"one\"", "\"two\"")),
        (
            "an unknown user",
            text.replace("user: \"r1\"", "user: \"r9\""),
        ),
        ("no user", without("usrpwd")),
    ];
    for (what, text) in wrong {
        let config = fleet.papers.path("wrong.json5");
        std::fs::write(&config, text).unwrap();
        assert!(connect(&config).is_err(), "{what} is let in");
    }
    let log = fleet.log();
    for reason in [
        "invalid peer certificate",
        "peer sent no certificates",
        "Invalid password",
        "Invalid user",
    ] {
        assert!(log.contains(reason), "{reason:?} is not in the log:\n{log}");
    }
}

#[test]
fn a_robot_writes_its_own_keys_alone() {
    let fleet = Fleet::new("rules");
    let robot = connect(&fleet.papers.of("r1", "one")).unwrap();
    let other = connect(&fleet.papers.of("r2", "two")).unwrap();
    let desk = connect(&fleet.papers.of("desk", "three")).unwrap();
    let seen = subscribe(&desk, "backcast/*/odometry");
    let others = subscribe(&other, "backcast/**");
    let own = subscribe(&other, "backcast/r2/*");
    // Data sent before the router knows the subscription is lost, so it is sent until it is
    // received.
    let until = |received: &Subscriber<FifoChannelHandler<Sample>>, puts: &[(&Session, &str)]| loop {
        for (session, key) in puts {
            session.put(*key, "x").wait().unwrap();
        }
        // Without a pause, more would be pending than a closing session can send.
        let pause = Duration::from_millis(5);
        if let Some(sample) = received.recv_timeout(pause).unwrap() {
            return sample.key_expr().to_string();
        }
    };
    // A key for all robots is not the robot's own either.
    let forged = [
        (&robot, "backcast/r2/odometry"),
        (&robot, "backcast/*/odometry"),
    ];
    let allowed = (&robot, "backcast/r1/odometry");
    let received = until(&seen, &[forged[0], forged[1], allowed]);
    assert_eq!(received, allowed.1);
    // The other robot receives the desk's commands, and nothing from the first robot.
    let scan = (&desk, "backcast/r2/scan");
    let allowed = (&desk, "backcast/r2/save");
    let received = until(&own, &[forged[0], forged[1], scan, allowed]);
    assert_eq!(received, "backcast/r2/save");
    // A session passes data received for one subscriber to all of its subscribers.
    let others = others.drain().map(|sample| sample.key_expr().to_string());
    let foreign: Vec<_> = others.filter(|key| key != "backcast/r2/save").collect();
    assert!(foreign.is_empty(), "a robot reads or receives {foreign:?}");
    drop((seen, own));
    for session in [robot, other, desk] {
        session.close().wait().unwrap();
    }
    let log = fleet.log();
    let forbidden = "unauthorized to Put (ingress) on backcast/r2/odometry";
    assert!(log.contains(forbidden), "{log}");
}

#[test]
fn a_late_joiner_gets_the_map_through_the_router() {
    let fleet = Fleet::new("kept");
    let isolated = Isolated::new("kept-r1");
    let graph = isolated.join("test");
    let maps = graph.publisher::<topic::Map>().unwrap();
    let drawn = DrawnMap::small();
    drawn.send(&maps);
    let health = graph.subscriber::<topic::Health>().unwrap();
    let config = fleet.papers.of("r1", "one");
    let bridge = bridge(&graph, &fleet.papers, "r1", &config);
    wait_for_health(&graph, &health, |report| report.sent > 0);
    let desk = connect(&fleet.papers.of("desk", "three")).unwrap();
    let (sender, samples) = std::sync::mpsc::channel();
    let _subscriber = desk
        .declare_subscriber("backcast/*/map")
        .callback(move |sample| drop(sender.send(sample)))
        .history(HistoryConfig::default().detect_late_publishers())
        .wait()
        .unwrap();
    let sample = samples.recv().unwrap();
    assert_eq!(sample.key_expr().as_str(), "backcast/r1/map");
    let encoding = sample.encoding().to_string();
    let map =
        network_payload::decode::<topic::Map>(&encoding, &sample.payload().to_bytes()).unwrap();
    assert_eq!(map.header.map_id, drawn.header.map_id);
    bridge.stop();
}
