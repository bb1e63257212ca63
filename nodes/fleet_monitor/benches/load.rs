//! Prints the load of many robots on the fleet monitor: processor time and memory, while all of
//! them send poses, beams and health like bridges, and one robot is watched:
//!
//!     cargo bench -p fleet_monitor --bench load -- --robots 100 --hz 20 --seconds 600
#![allow(clippy::unwrap_used, reason = "it fails where a test would")]

use std::net::TcpStream;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::time::{Duration, Instant};

use bytemuck::Zeroable;
use clap::Parser;
use messages::{
    Beam, BeamsHeader, HealthHeader, HypothesesHeader, Hypothesis, Name, NodeState, Pose2, Verdict,
    topic,
};
use network_payload::{Preamble, Wire};
use tests::http::Site;
use transport::testing::{Isolated, NodeProcess, wait_until_ready};
use transport::{Flow, Graph, TransportError, monotonic_ns};
use zenoh::bytes::Encoding;
use zenoh::pubsub::Publisher;
use zenoh::{Session, Wait};

/// Interval at which processor time and memory are printed.
const PERIOD: Duration = Duration::from_secs(10);
const BEAMS: usize = 180;

/// Options of the benchmark.
#[derive(Parser)]
struct Config {
    /// Number of robots
    #[arg(long, default_value_t = 100)]
    robots: usize,

    /// Scans per second and robot
    #[arg(long, default_value_t = 20.0)]
    hz: f64,

    /// Duration in seconds
    #[arg(long, default_value_t = 60)]
    seconds: u64,

    /// Flag that cargo passes to every benchmark
    #[arg(long, hide = true)]
    bench: bool,
}

fn main() {
    let config = Config::parse();
    let isolated = Isolated::for_long("load");
    let graph = isolated.join("bench");
    let site = Site::free();
    let endpoint = format!("tcp/{}:7447", isolated.name().loopback());
    let page = site.0.to_string();
    let arguments = ["--page", &page, "--listen", &endpoint];
    let node = NodeProcess::start(env!("CARGO_BIN_EXE_fleet_monitor"), &graph, arguments);
    wait_until_ready(&graph, "fleet_monitor");
    let (stop, messages) = (AtomicBool::new(false), AtomicU64::new(0));
    std::thread::scope(|scope| {
        scope.spawn(|| send(&endpoint, &config, &stop));
        scope.spawn(|| look(site, &stop, &messages));
        watch(&graph, &config, &messages);
        stop.store(true, Ordering::Relaxed);
    });
    node.stop();
}

/// Prints the node's resource use, and message rates from its own reports.
fn watch(graph: &Graph, config: &Config, messages: &AtomicU64) {
    let health = graph.subscriber::<topic::Health>().unwrap();
    let start = Instant::now();
    let mut due = PERIOD;
    let mut last: Option<(f64, HealthHeader, Instant)> = None;
    println!(
        "{:>7} {:>10} {:>9} {:>9} {:>8} {:>12}",
        "seconds", "messages/s", "dropped", "cores", "MB", "to the page"
    );
    let outcome = graph.run(&[&health], Duration::from_millis(100), |_| {
        while let Some(sample) = health.receive()? {
            let report = *sample.header();
            if report.node.as_str() != "fleet_monitor" || start.elapsed() < due {
                continue;
            }
            let (cpu_s, now) = (processor_s(report.pid), Instant::now());
            if let Some((last_s, before, then)) = last {
                let passed_s = now.duration_since(then).as_secs_f64();
                println!(
                    "{:>7.0} {:>10.0} {:>9} {:>9.3} {:>8.1} {:>12}",
                    start.elapsed().as_secs_f64(),
                    (report.received - before.received) as f64 / passed_s,
                    report.dropped,
                    (cpu_s - last_s) / passed_s,
                    memory_mb(report.pid),
                    messages.swap(0, Ordering::Relaxed),
                );
            }
            last = Some((cpu_s, report, now));
            due += PERIOD;
        }
        let is_over = start.elapsed().as_secs() >= config.seconds;
        Ok::<_, TransportError>(if is_over { Flow::Stop } else { Flow::Continue })
    });
    outcome.unwrap();
}

/// Returns the processor time that a process has used so far, seconds.
fn processor_s(pid: u32) -> f64 {
    // Summed over the threads; those that have ended are not included.
    let tasks = std::fs::read_dir(format!("/proc/{pid}/task")).unwrap();
    let nanoseconds = tasks.filter_map(|task| {
        let text = std::fs::read_to_string(task.ok()?.path().join("schedstat")).ok()?;
        text.split(' ').next()?.parse::<u64>().ok()
    });
    nanoseconds.sum::<u64>() as f64 / 1e9
}

/// Returns the resident memory of a process, megabytes.
fn memory_mb(pid: u32) -> f64 {
    let text = std::fs::read_to_string(format!("/proc/{pid}/status")).unwrap();
    let line = text
        .lines()
        .find(|line| line.starts_with("VmRSS:"))
        .unwrap();
    let kilobytes: f64 = line.split_whitespace().nth(1).unwrap().parse().unwrap();
    kilobytes / 1024.0
}

/// Watches one robot on the page.
fn look(Site(address): Site, stop: &AtomicBool, messages: &AtomicU64) {
    let url = format!("ws://{address}/api/v1/robots/r0/stream");
    while !stop.load(Ordering::Relaxed) {
        let stream = TcpStream::connect(address).unwrap();
        // There is no stream until the robot is known.
        let Ok((mut socket, _)) = tungstenite::client(&url, stream) else {
            std::thread::sleep(Duration::from_millis(100));
            continue;
        };
        while !stop.load(Ordering::Relaxed) && socket.read().is_ok() {
            messages.fetch_add(1, Ordering::Relaxed);
        }
    }
}

/// Publishers of one robot's bridge.
struct FarRobot {
    name: String,
    hypotheses: Publisher<'static>,
    beams: Publisher<'static>,
    health: Publisher<'static>,
}

impl FarRobot {
    fn new(session: &Session, number: usize) -> Self {
        let name = format!("r{number}");
        FarRobot {
            hypotheses: publisher::<topic::Hypotheses>(session, &name),
            beams: publisher::<topic::Beams>(session, &name),
            health: publisher::<topic::Health>(session, &name),
            name,
        }
    }

    /// Sends the messages of one scan, and a health report with this number if given.
    fn send(&self, counter: u64, report: Option<u64>) {
        let mut header = HypothesesHeader {
            verdict: Verdict::Unique as u32,
            ..HypothesesHeader::zeroed()
        };
        header.stamp.counter = counter;
        header.stamp.entered_ns = monotonic_ns();
        header.sent_ns = monotonic_ns();
        let angle = counter as f64 * 0.01;
        let place = Hypothesis {
            map_from_laser: Pose2 {
                x: angle.cos(),
                y: angle.sin(),
                yaw: angle,
            },
            ..Hypothesis::zeroed()
        };
        put::<topic::Hypotheses>(&self.hypotheses, counter, &header, &[place]);
        let beams = BeamsHeader {
            stamp: header.stamp,
            ..BeamsHeader::zeroed()
        };
        put::<topic::Beams>(&self.beams, counter, &beams, &[Beam::zeroed(); BEAMS]);
        if let Some(number) = report {
            let mut report = HealthHeader {
                node: Name::new(&self.name),
                state: NodeState::Ready as u32,
                ..HealthHeader::zeroed()
            };
            report.sent_ns = monotonic_ns();
            put::<topic::Health>(&self.health, number, &report, &[]);
        }
    }
}

fn publisher<T: Wire>(session: &Session, robot: &str) -> Publisher<'static> {
    let publisher = session.declare_publisher(network_payload::key::<T>(robot));
    let publisher = publisher.encoding(Encoding::from(network_payload::encoding::<T>()));
    publisher.wait().unwrap()
}

fn put<T: Wire>(to: &Publisher<'_>, sequence: u64, header: &T::Header, items: &[T::Item]) {
    let preamble = Preamble {
        sender: 7,
        sequence,
        clock_ns: monotonic_ns(),
    };
    let payload = network_payload::encode::<T>(&preamble, header, items).unwrap();
    to.put(payload).wait().unwrap();
}

/// Sends for all robots in turn, evenly spread over time.
fn send(endpoint: &str, config: &Config, stop: &AtomicBool) {
    let session = zenoh_session::testing::client(endpoint);
    let robots: Vec<_> = (0..config.robots)
        .map(|number| FarRobot::new(&session, number))
        .collect();
    let period = Duration::from_secs_f64(1.0 / config.hz / config.robots as f64);
    let start = Instant::now();
    let turns = (0u64..).flat_map(|counter| robots.iter().map(move |robot| (counter, robot)));
    for (turn, (counter, robot)) in turns.enumerate() {
        if stop.load(Ordering::Relaxed) {
            return;
        }
        let due = period.mul_f64(turn as f64);
        std::thread::sleep(due.saturating_sub(start.elapsed()));
        // One report per second.
        let each = config.hz.ceil().max(1.0) as u64;
        let report = counter.is_multiple_of(each).then(|| counter / each);
        robot.send(counter, report);
    }
}
