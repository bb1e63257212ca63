//! Tests of the server as a process, over loopback connections.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod handed_on;
mod set;

use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::thread::ScopedJoinHandle;
use std::time::Duration;

use crossbeam::channel::{Receiver, unbounded};
use locate_server::{
    BUSY, JSON, JSON_ANSWER, LATE, LocateError, Locator, REFUSED, SearchedMap, Workspace, ask,
};
use messages::{ScanHeader, topic};
use network_payload::Preamble;
use tests::world::{World, as_the_graph_has_it};
use transport::Graph;
use transport::testing::{Isolated, NodeProcess, wait_for_health, wait_until, wait_until_ready};
use zenoh::bytes::Encoding;
use zenoh::handlers::FifoChannelHandler;
use zenoh::query::{ConsolidationMode, Query, QueryTarget, Queryable, Reply, ReplyError};
use zenoh::{Session, Wait};

/// Longer than any answer takes on any machine.
const TIMEOUT: Duration = Duration::from_secs(60);

struct Server {
    process: NodeProcess,
    graph: Graph,
    // Declared after the graph, so that it is dropped after it.
    isolated: Isolated,
}

fn world() -> World {
    World::of("malaga_corridor")
}

impl Server {
    fn start(tag: &str, arguments: &[&str]) -> Self {
        let map = world().map();
        let common = ["--map", map.to_str().unwrap(), "--name", "corridor"];
        Server::of(tag, &[&common, arguments].concat())
    }

    fn of(tag: &str, arguments: &[&str]) -> Self {
        let isolated = Isolated::new(tag);
        let graph = isolated.join("test");
        let listen = endpoint(&isolated);
        let common = ["--listen", &listen];
        let executable = env!("CARGO_BIN_EXE_locate_server");
        let process = NodeProcess::start(executable, &graph, common.iter().chain(arguments));
        wait_until_ready(&graph, "locate_server");
        Server {
            process,
            graph,
            isolated,
        }
    }

    fn endpoint(&self) -> String {
        endpoint(&self.isolated)
    }

    /// Waits until the server has sent this many answers while `asking` runs.
    fn wait_until_sent(&self, answers: u64, asking: &ScopedJoinHandle<'_, ()>) {
        let health = self.graph.subscriber::<topic::Health>().unwrap();
        wait_for_health(&self.graph, &health, |report| {
            assert!(!asking.is_finished(), "a request has no answer");
            report.sent >= answers
        });
    }
}

fn endpoint(isolated: &Isolated) -> String {
    format!("tcp/{}:7447", isolated.name().loopback())
}

fn caller(servers: &[&Server]) -> Session {
    let endpoints: Vec<_> = servers.iter().map(|server| server.endpoint()).collect();
    session(&[], &endpoints)
}

fn session(listen: &[String], connect: &[String]) -> Session {
    let mut config = zenoh::Config::default();
    let mut set = |key, value: &str| config.insert_json5(key, value).unwrap();
    set("connect/endpoints", &format!("{connect:?}"));
    set("listen/endpoints", &format!("{listen:?}"));
    set("scouting/multicast/enabled", "false");
    zenoh::open(config).wait().unwrap()
}

type Scan = (ScanHeader, Vec<f32>);

fn scans() -> Vec<Scan> {
    let recorded = world().scans().into_iter().zip(0..);
    recorded
        .map(|(scan, counter)| (as_the_graph_has_it(&scan, counter), scan.ranges))
        .collect()
}

/// Sends a request with arbitrary bytes; returns the only reply.
fn ask_raw(session: &Session, parameters: &str, encoding: &str, payload: Vec<u8>) -> Reply {
    let replies = session
        .get(format!("backcast/locate/corridor{parameters}"))
        .payload(payload)
        .encoding(Encoding::from(encoding))
        .timeout(TIMEOUT)
        .wait()
        .unwrap();
    let mut replies: Vec<_> = replies.into_iter().collect();
    assert_eq!(replies.len(), 1, "one answer");
    replies.remove(0)
}

fn searched(name: &str, map: &map::OccupancyGrid) -> SearchedMap {
    let (rules, settings) = (Default::default(), Default::default());
    SearchedMap::new(name.to_owned(), map, rules, settings).unwrap()
}

/// Asserts that a request failed with this encoding; returns the reason.
#[track_caller]
fn failed_as(reply: Reply, encoding: &str) -> ReplyError {
    let error = reply.into_result().unwrap_err();
    assert_eq!(error.encoding().to_string(), encoding);
    error
}

fn json_of((header, ranges): &Scan) -> Vec<u8> {
    let ranges: Vec<_> = ranges.iter().map(|r| r.is_finite().then_some(r)).collect();
    let value = serde_json::json!({
        "angle_min": header.angle_min,
        "angle_increment": header.angle_increment,
        "range_min": header.range_min_m,
        "range_max": header.range_max_m,
        "ranges": ranges,
    });
    value.to_string().into_bytes()
}

/// Sends a request without waiting for the answer, which may take a minute.
fn ask_json(session: &Session, scan: &Scan) -> FifoChannelHandler<Reply> {
    session
        .get("backcast/locate/corridor?deadline_ms=60000")
        .payload(json_of(scan))
        .encoding(Encoding::from(JSON))
        .timeout(TIMEOUT)
        .wait()
        .unwrap()
}

#[test]
fn answers_are_those_of_the_engine() {
    let server = Server::start("answers", &[]);
    let session = caller(&[&server]);
    let map = map::load(world().map()).unwrap();
    let locator = Locator::of_set(vec![searched("", &map)]).unwrap();
    let mut workspace = Workspace::default();
    for scan in scans() {
        let asked = (&scan.0, scan.1.as_slice());
        let found = ask(&session, "corridor", asked, TIMEOUT).unwrap();
        let expected = locator.locate(&mut workspace, asked, &|| false).unwrap();
        let (header, hypotheses) = expected.unwrap();
        assert_eq!(found.items, hypotheses);
        assert_eq!(found.header.verdict, header.verdict);
        assert_eq!(found.header.stamp.counter, header.stamp.counter);
        assert_eq!(found.header.map_id, map.id());
        let reply = ask_raw(&session, "", JSON, json_of(&scan));
        let sample = reply.into_result().unwrap();
        assert_eq!(sample.encoding().to_string(), JSON_ANSWER);
        let value: serde_json::Value =
            serde_json::from_slice(&sample.payload().to_bytes()).unwrap();
        let best = &value["hypotheses"][0]["laser"];
        assert_eq!(best["x"], hypotheses[0].map_from_laser.x);
    }
    server.process.stop();
}

#[test]
fn what_is_no_request_is_refused_and_counted() {
    let server = Server::start("refused", &[]);
    let session = caller(&[&server]);
    let scan = &scans()[0];
    let preamble = Preamble {
        sender: 1,
        sequence: 1,
        clock_ns: 0,
    };
    let sound = network_payload::encode::<topic::Scan>(&preamble, &scan.0, &scan.1).unwrap();
    let postcard = network_payload::encoding::<topic::Scan>();
    let mut cut = sound.clone();
    cut.pop();
    let still = br#"{"angle_min":0,"angle_increment":0,"range_max":9,"ranges":[1]}"#;
    let wrong = [
        ("", "zenoh/bytes", sound.clone()),
        ("", postcard.as_str(), cut),
        ("", postcard.as_str(), vec![0xff; 2 << 20]),
        ("", JSON, b"{}".to_vec()),
        ("", JSON, still.to_vec()),
        ("?deadline_ms=soon", postcard.as_str(), sound.clone()),
    ];
    let count = wrong.len() as u64;
    for (parameters, encoding, payload) in wrong {
        let reply = ask_raw(&session, parameters, encoding, payload);
        assert!(!failed_as(reply, REFUSED).payload().is_empty());
    }
    // What comes with a request waits with it, and counts.
    let get = session.get("backcast/locate/corridor");
    let get = get.payload(sound.clone()).encoding(postcard.as_str());
    let replies = get.attachment(vec![0; 2 << 20]).timeout(TIMEOUT).wait();
    failed_as(replies.unwrap().recv().unwrap(), REFUSED);
    let health = server.graph.subscriber::<topic::Health>().unwrap();
    wait_for_health(&server.graph, &health, |report| report.refused == count + 1);
    // The client does not repeat such a request either, since that would not help.
    let empty = ask(&session, "corridor", (&scan.0, &[]), TIMEOUT);
    assert!(
        matches!(empty, Err(LocateError::Refused { .. })),
        "{empty:?}"
    );
    // The server keeps working.
    assert!(ask_raw(&session, "", &postcard, sound).result().is_ok());
    server.process.stop();
}

#[test]
fn what_cannot_be_answered_in_time_is_not_searched() {
    let server = Server::start("late", &[]);
    let session = caller(&[&server]);
    // A search takes many times longer.
    let payload = json_of(&scans()[0]);
    failed_as(ask_raw(&session, "?deadline_ms=1", JSON, payload), LATE);
    server.process.stop();
}

#[test]
fn beyond_its_queue_a_server_is_busy() {
    let server = Server::start("busy", &["--workers", "1", "--waiting", "0"]);
    let session = caller(&[&server]);
    let scan = &scans()[0];
    let (mut answers, mut busy) = (0, 0);
    // Repeats until more than two requests arrive at the same time.
    while answers == 0 || busy == 0 {
        let asking: Vec<_> = (0..20).map(|_| ask_json(&session, scan)).collect();
        for replies in asking {
            let reply = replies.recv().unwrap();
            if reply.result().is_ok() {
                answers += 1;
            } else {
                failed_as(reply, BUSY);
                busy += 1;
            }
        }
    }
    server.process.stop();
}

/// Sends requests on several threads until `stop` is set, and counts the answers.
fn keep_asking(session: &Session, stop: &AtomicBool, answered: &AtomicUsize) {
    let scans = scans();
    std::thread::scope(|scope| {
        for _ in 0..4 {
            scope.spawn(|| {
                for (header, ranges) in scans.iter().cycle() {
                    if stop.load(Ordering::Relaxed) {
                        return;
                    }
                    let answer = ask(session, "corridor", (header, ranges), TIMEOUT).unwrap();
                    assert_eq!(answer.header.stamp.counter, header.stamp.counter);
                    answered.fetch_add(1, Ordering::Relaxed);
                }
            });
        }
    });
}

#[test]
fn a_request_is_brought_to_one_server() {
    let first = Server::start("once-a", &[]);
    let endpoint = first.endpoint();
    let second = Server::start("once-b", &["--connect", &endpoint]);
    // The result is the same whichever server is asked.
    for asked in [&first, &second] {
        assert_one_receives_it(asked);
    }
    first.process.stop();
    second.process.stop();
}

fn assert_one_receives_it(server: &Server) {
    let session = caller(&[server]);
    // Each server that receives an empty request rejects it.
    let receivers = || {
        let get = session.get("backcast/locate/corridor");
        let get = get.target(QueryTarget::All);
        let get = get.consolidation(ConsolidationMode::None);
        get.timeout(TIMEOUT).wait().unwrap().into_iter().count()
    };
    // Until the servers have discovered each other, both receive requests.
    while receivers() != 1 {
        std::thread::yield_now();
    }
    for scan in scans() {
        let asked = (&scan.0, scan.1.as_slice());
        ask(&session, "corridor", asked, TIMEOUT).unwrap();
    }
    assert_eq!(receivers(), 1);
}

#[test]
fn several_servers_share_the_work_and_a_dead_one_costs_no_answer() {
    let one = ["--workers", "1"];
    let first = Server::start("first", &one);
    let endpoint = first.endpoint();
    let connect = ["--connect", endpoint.as_str()];
    let second = Server::start("second", &[one, connect].concat());
    let third = Server::start("third", &[one, connect].concat());
    let session = caller(&[&first, &second]);
    let (stop, answered) = (AtomicBool::new(false), AtomicUsize::new(0));
    std::thread::scope(|scope| {
        let asking = scope.spawn(|| keep_asking(&session, &stop, &answered));
        // All servers get a share, whichever is asked.
        for server in [&first, &second, &third] {
            server.wait_until_sent(5, &asking);
        }
        // Kills one server that requests are forwarded to, and one that is asked.
        let before = answered.load(Ordering::Relaxed);
        third.process.kill();
        second.wait_until_sent(20, &asking);
        first.process.kill();
        second.wait_until_sent(60, &asking);
        assert!(answered.load(Ordering::Relaxed) > before);
        stop.store(true, Ordering::Relaxed);
    });
    second.process.stop();
}

/// Declares a queryable that stores queries without answering them.
fn stand_silent(session: &Session, key: &str) -> (Queryable<()>, Receiver<Query>) {
    let (sender, kept) = unbounded();
    let queryable = session
        .declare_queryable(key.to_owned())
        .complete(true)
        .callback(move |query| sender.send(query).unwrap())
        .wait();
    (queryable.unwrap(), kept)
}

#[test]
fn a_request_that_nobody_ends_is_asked_again() {
    let isolated = Isolated::new("silent");
    let endpoint = endpoint(&isolated);
    let there = session(std::slice::from_ref(&endpoint), &[]);
    let (_silent, kept) = stand_silent(&there, "backcast/locate/attic");
    let caller = session(&[], &[endpoint]);
    let (header, ranges) = &scans()[0];
    std::thread::scope(|scope| {
        let asking = scope.spawn(|| ask(&caller, "attic", (header, ranges), TIMEOUT));
        let _unanswered = kept.recv().unwrap();
        let again = kept.recv().unwrap();
        let refusal = again.reply_err("no such room").encoding(REFUSED);
        refusal.wait().unwrap();
        let answer = asking.join().unwrap();
        assert!(
            matches!(&answer, Err(LocateError::Refused { says }) if says == "no such room"),
            "{answer:?}"
        );
    });
}
