//! Prints how many scans per second one server and two servers locate, each in a network namespace
//! and on a core of its own:
//!
//!     cargo bench -p locate_server --bench replicas
//!
//! This needs the right to create network namespaces, as the bridge's tests do. To measure servers
//! that are already running:
//!
//!     cargo bench -p locate_server --bench replicas -- \
//!         --connect tcp/192.168.0.7:7447 --name office --recording drive.mcap
#![allow(clippy::unwrap_used, reason = "it fails where a test would")]

use std::path::PathBuf;
use std::sync::Mutex;
use std::time::{Duration, Instant};

use clap::Parser;
use messages::topic;
use tests::network::Namespace;
use tests::world::{World, as_the_graph_has_it, scans_of};
use transport::Graph;
use transport::testing::{Isolated, NodeProcess, wait_for_health, wait_until_ready};
use zenoh::Wait;

const WORLD: &str = "malaga_corridor";

/// The first server listens; the second one and the client connect to it.
const LISTEN: [&str; 2] = ["--listen", "tcp/0.0.0.0:7447"];
const CONNECT: [&str; 2] = ["--connect", "tcp/10.77.1.1:7447"];

/// Sends requests as fast as they are answered.
#[derive(Parser)]
struct Config {
    /// Name of the map
    #[arg(long, default_value = WORLD)]
    name: String,

    /// Recording whose scans are sent [default: the one in the repository]
    #[arg(long)]
    recording: Option<PathBuf>,

    /// Number of requests open at the same time
    #[arg(long, default_value_t = 8)]
    callers: usize,

    /// Number of requests
    #[arg(long, default_value_t = 1000)]
    requests: usize,

    #[command(flatten)]
    network: zenoh_session::Options,

    /// Flag that cargo passes to every benchmark
    #[arg(long, hide = true)]
    bench: bool,
}

fn main() {
    let config = Config::parse();
    let has_address = config.network.config.is_some() || !config.network.connect.is_empty();
    if has_address {
        load(&config);
    } else {
        compare();
    }
}

fn compare() {
    let (first, second) = (Namespace::new(), Namespace::new());
    first.connect(&second, "cable1", ["10.77.1.1/24", "10.77.1.2/24"]);
    let one = Server::start("one", (&first, "0"), &LISTEN);
    println!("one server on one core");
    load_from(&second);
    let other = Server::start("two", (&second, "1"), &CONNECT);
    println!("two servers on a core each");
    load_from(&second);
    for server in [one, other] {
        server.print();
        server.process.stop();
    }
}

struct Server {
    process: NodeProcess,
    graph: Graph,
    // Declared after the graph, so that it is dropped after it.
    _isolated: Isolated,
}

impl Server {
    fn start(tag: &str, (place, core): (&Namespace, &str), network: &[&str]) -> Self {
        let isolated = Isolated::new(tag);
        let graph = isolated.join("test");
        let map = World::of(WORLD).map();
        let common = [
            "--cpu-list",
            core,
            env!("CARGO_BIN_EXE_locate_server"),
            "--workers",
            "1",
            "--map",
            map.to_str().unwrap(),
        ];
        let process = place.start(&graph, "taskset", &[&common[..], network].concat());
        wait_until_ready(&graph, "locate_server");
        Server {
            process,
            graph,
            _isolated: isolated,
        }
    }

    fn print(&self) {
        let health = self.graph.subscriber::<topic::Health>().unwrap();
        let (report, _) = wait_for_health(&self.graph, &health, |_| true);
        let (asked, answered, busy) = (report.received, report.sent, report.dropped);
        println!("a server: asked {asked} times, answered {answered}, too busy for {busy}");
    }
}

/// Runs this program in a namespace, as the client.
fn load_from(place: &Namespace) {
    let program = std::env::current_exe().unwrap();
    let mut command = place.command(program.to_str().unwrap());
    let status = command.args(CONNECT).status();
    assert!(status.unwrap().success());
}

fn load(config: &Config) {
    let recording = config.recording.clone();
    let recording = recording.unwrap_or_else(|| World::of(WORLD).recording());
    let scans: Vec<_> = scans_of(&recording)
        .into_iter()
        .map(|scan| (as_the_graph_has_it(&scan, 0), scan.ranges))
        .collect();
    let settings = zenoh_session::settings(&config.network).unwrap();
    let session = zenoh::open(settings).wait().unwrap();
    let patience = Duration::from_secs(60);
    let ask = |i: usize| {
        let (header, ranges) = &scans[i % scans.len()];
        let start = Instant::now();
        locate_server::ask(&session, &config.name, (header, ranges), patience).unwrap();
        start.elapsed().as_secs_f64() * 1e3
    };
    // The first request waits for a server.
    ask(0);
    let times = Mutex::new(Vec::new());
    let start = Instant::now();
    std::thread::scope(|scope| {
        for caller in 0..config.callers {
            let (times, config) = (&times, &config);
            scope.spawn(move || {
                for i in (caller..config.requests).step_by(config.callers) {
                    let time = ask(i);
                    times.lock().unwrap().push(time);
                }
            });
        }
    });
    let seconds = start.elapsed().as_secs_f64();
    let mut times = times.into_inner().unwrap();
    times.sort_by(f64::total_cmp);
    let at = |share: f64| times[(share * (times.len() - 1) as f64).round() as usize];
    println!(
        "{:.0} answers a second, {:.1} ms median, {:.1} ms p90",
        times.len() as f64 / seconds,
        at(0.5),
        at(0.9)
    );
}
