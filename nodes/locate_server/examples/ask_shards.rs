//! Asks the servers of a set of maps for each scan of a recording, and prints the merged
//! answers, as text or as an object a line:
//!
//!     cargo run --release -p locate_server --example ask_shards -- \
//!         --connect tcp/192.168.0.7:7447 --set campus --json drive.mcap
//!
//! Ends with code 1 where a scan has no answer.
#![allow(clippy::unwrap_used, reason = "it fails where a test would")]

use std::path::PathBuf;
use std::time::{Duration, Instant};

use clap::Parser;
use engine::peaks::{PeakConfig, Place};
use locate_server::{OverMaps, ask_shards};
use serde_json::{Value, json};
use tests::world::{as_the_graph_has_it, scans_of};
use zenoh::{Session, Wait};

#[derive(Parser)]
struct Config {
    /// The recording, an MCAP file
    recording: PathBuf,

    /// Where the servers listen, given once for each
    #[arg(long, value_name = "ENDPOINT", required = true)]
    connect: Vec<String>,

    /// The name of the set
    #[arg(long, value_name = "NAME")]
    set: String,

    /// Take every N-th scan
    #[arg(long, value_name = "N", default_value = "1")]
    every: std::num::NonZeroUsize,

    /// Ask for so many scans at most, from the first one again where the recording ends
    #[arg(long, value_name = "COUNT")]
    scans: Option<usize>,

    /// How long an answer may take, milliseconds
    #[arg(long, value_name = "MS", default_value_t = 2000)]
    deadline: u64,

    /// Print JSON, an object a line
    #[arg(long)]
    json: bool,
}

fn main() {
    let config = Config::parse();
    let session = connect(&config.connect);
    let recorded = scans_of(&config.recording);
    let taken = recorded.iter().step_by(config.every.get());
    let count = config.scans.unwrap_or(taken.len());
    let mut unanswered = 0;
    for (scan, counter) in taken.cycle().take(count).zip(0..) {
        let header = as_the_graph_has_it(scan, counter);
        let (asked, deadline) = (Instant::now(), Duration::from_millis(config.deadline));
        let scan = (&header, scan.ranges.as_slice());
        let answer = ask_shards(
            &session,
            &config.set,
            scan,
            deadline,
            &PeakConfig::default(),
        );
        let waited_ms = asked.elapsed().as_secs_f64() * 1e3;
        match answer {
            Ok(found) if config.json => {
                println!("{}", object(header.stamp.measured_ns, &found, waited_ms));
            }
            Ok(found) => println!("{}", line(counter, &found, waited_ms)),
            Err(error) => {
                eprintln!("scan {counter}: {error}");
                unanswered += 1;
            }
        }
    }
    if unanswered > 0 {
        eprintln!("{unanswered} of {count} scans have no answer");
        std::process::exit(1);
    }
}

fn connect(endpoints: &[String]) -> Session {
    let mut config = zenoh::Config::default();
    let mut set = |key, value: &str| config.insert_json5(key, value).unwrap();
    set("connect/endpoints", &format!("{endpoints:?}"));
    set("listen/endpoints", "[]");
    set("scouting/multicast/enabled", "false");
    zenoh::open(config).wait().unwrap()
}

fn line(counter: u64, found: &OverMaps, waited_ms: f64) -> String {
    let slowest_ms = found.slowest.as_secs_f64() * 1e3;
    let best = found.places.places.first().map(|place| {
        let at = place.map_from_laser;
        let map = found.map().unwrap_or_default();
        format!(
            "{map} at {:.2} {:.2} {:.1}°",
            at.x,
            at.y,
            at.yaw.to_degrees()
        )
    });
    let mut line = format!(
        "scan {counter}: {} on {}, {} places, {waited_ms:.0} ms, slowest search {slowest_ms:.0} ms",
        found.places.verdict,
        best.unwrap_or_else(|| "no map".to_owned()),
        found.places.places.len(),
    );
    if !found.not_searched.is_empty() {
        line += &format!("; not searched: {}", found.not_searched.join(", "));
    }
    line
}

fn object(stamp_ns: i64, found: &OverMaps, waited_ms: f64) -> Value {
    let hypothesis = |place: &Place| {
        let at = place.map_from_laser;
        json!({
            "map": found.maps.get(place.map as usize),
            "x": at.x, "y": at.y, "yaw": at.yaw,
            "score": place.score,
            "probability": place.probability,
        })
    };
    let hypotheses: Vec<Value> = found.places.places.iter().map(hypothesis).collect();
    json!({
        "stamp_ns": stamp_ns,
        "verdict": found.places.verdict.to_string(),
        "map": found.map(),
        "not_searched": found.not_searched,
        "slowest_ms": found.slowest.as_secs_f64() * 1e3,
        "waited_ms": waited_ms,
        "hypotheses": hypotheses,
    })
}
