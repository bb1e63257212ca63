//! Runs a graph for hours, injects random faults, and reports whether it met its guarantees: every
//! pose that the tracker is sure of is compared with the recording's `/ground_truth`. The report is
//! JSON; the exit code is 0 if all guarantees were met. The graph's executables must be next to
//! this one.

mod course;
mod fault;
mod filler;
mod launched;
mod maps;
mod recorded;
mod report;
mod tally;
mod usage;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Duration;

use anyhow::{Context, ensure};
use clap::Parser;
use command_line::{output, stdout::print};
use dataflow::RestartPolicy;
use geometry::Pose;
use launcher::descriptor::{self, Builds, DEFAULT_FILE, Descriptor};
use launcher::run::Options;
use launcher::run::arguments::{MAP_SERVER, PLAYERS, value};
use recording::Recording;
use transport::GraphName;

use course::{Course, Plan};
use fault::Fault;
use maps::Maps;

const DEFAULT_FAULTS: [Fault; 4] = [Fault::Kill, Fault::Pair, Fault::Stop, Fault::Map];
const PART: &str = "5m";

/// Runs a graph for a long time under faults and checks that it recovers.
#[derive(Debug, Parser)]
struct Config {
    /// Descriptor of the graph
    #[arg(default_value = DEFAULT_FILE, value_name = "FILE")]
    dataflow: PathBuf,

    /// Duration in minutes
    #[arg(long, value_name = "M", value_parser = positive, default_value_t = 60.0)]
    minutes: f64,

    /// Recording to replay, which must contain the ground truth [default: that of the descriptor]
    #[arg(long, value_name = "FILE")]
    replay: Option<PathBuf>,

    /// Map to serve [default: that of the descriptor]
    #[arg(long, value_name = "FILE")]
    map: Option<PathBuf>,

    /// Record the graph to parts of this name, FILE_0.mcap and so on, which are read at the end
    #[arg(long, value_name = "FILE")]
    record: Option<PathBuf>,

    /// The faults to inject, separated by commas
    #[arg(long, value_enum, value_name = "FAULTS", value_delimiter = ',', default_values_t = DEFAULT_FAULTS)]
    faults: Vec<Fault>,

    /// Minimum time between faults, seconds; the next fault waits until the graph has
    /// recovered from the last
    #[arg(long, value_name = "SECONDS", value_parser = positive, default_value_t = 3.0)]
    pause: f64,

    /// Seed of the random numbers
    #[arg(long, value_name = "NUMBER", default_value_t = 1)]
    seed: u64,

    /// Name of the graph [default: a generated name]
    #[arg(long, value_name = "NAME", value_parser = GraphName::new)]
    graph: Option<GraphName>,
}

fn main() -> anyhow::Result<ExitCode> {
    let config = Config::parse();
    transport::node::start_logging().map_err(anyhow::Error::msg)?;
    let descriptor = descriptor::load(&config.dataflow, Builds::Run)?;
    let truths = truths(&file(&descriptor, &config.replay, &PLAYERS, "--recording")?)?;
    check_room(&config)?;
    let folder = tempfile::tempdir().context("cannot create a temporary folder")?;
    let map = file(&descriptor, &config.map, &[MAP_SERVER], "--map")?;
    let maps = Maps::new(&map, folder.path())?;
    let graph = match &config.graph {
        Some(graph) => graph.clone(),
        None => Options::default().graph_name()?,
    };
    let plan = Plan {
        arguments: config.arguments(&graph, &maps),
        victims: victims(&descriptor),
        graph,
        lasts: Duration::from_secs_f64(60.0 * config.minutes),
        pause: Duration::from_secs_f64(config.pause),
        faults: config.faults,
        seed: config.seed,
        record: config.record,
    };
    let report = Course::start(plan, maps, truths)?.run()?;
    print(&(serde_json::to_string_pretty(&report)? + "\n"))?;
    Ok(match report.is_good() {
        true => ExitCode::SUCCESS,
        false => ExitCode::FAILURE,
    })
}

impl Config {
    fn arguments(&self, graph: &GraphName, maps: &Maps) -> Vec<String> {
        let text = |path: &Path| path.display().to_string();
        let mut arguments = vec![text(&self.dataflow), "--json".into(), "--loop".into()];
        arguments.extend(["--graph".into(), graph.to_string()]);
        arguments.extend(["--map".into(), text(maps.served())]);
        for (option, file) in [("--replay", &self.replay), ("--record", &self.record)] {
            if let Some(file) = file {
                arguments.extend([option.into(), text(file)]);
            }
        }
        if self.record.is_some() {
            // A launcher that is started again goes on with the next part.
            arguments.push(format!("--split-time={PART}"));
        }
        arguments
    }
}

fn file(
    descriptor: &Descriptor,
    given: &Option<PathBuf>,
    executables: &[&str],
    option: &str,
) -> anyhow::Result<PathBuf> {
    if let Some(file) = given {
        return Ok(file.clone());
    }
    let mut nodes = descriptor.dataflow.nodes.iter();
    let node = nodes.find(|node| executables.contains(&node.executable()));
    let file = node.and_then(|node| value(node, option));
    let file = file.with_context(|| format!("the descriptor has no {executables:?} {option}"))?;
    Ok(descriptor.folder.join(file))
}

fn victims(descriptor: &Descriptor) -> Vec<String> {
    let nodes = descriptor.dataflow.nodes.iter();
    let again = nodes.filter(|node| node.restart.policy != RestartPolicy::Never);
    again.map(|node| node.id.clone()).collect()
}

fn truths(recording: &Path) -> anyhow::Result<BTreeMap<i64, Pose>> {
    let truths = Recording::open(recording)?.ground_truths()?;
    let file = recording.display();
    ensure!(!truths.is_empty(), "{file} has no poses on /ground_truth");
    let pose = |(stamp_ns, truth): (i64, recording::GroundTruth)| (stamp_ns, truth.pose);
    Ok(truths.into_iter().map(pose).collect())
}

fn check_room(config: &Config) -> anyhow::Result<()> {
    if config.faults.contains(&Fault::Shm) {
        filler::check(Path::new("/dev/shm"))?;
    }
    if config.faults.contains(&Fault::Disk) {
        let record = config.record.as_ref();
        let record = record.context("--faults disk fills the disk of --record")?;
        filler::check(output::folder_of(record))?;
    }
    Ok(())
}

fn positive(text: &str) -> Result<f64, String> {
    match text.parse() {
        // More than a week, but no overflow of any clock.
        Ok(value) if value > 0.0 && value <= 1e4 => Ok(value),
        _ => Err("allowed is a number above 0, up to 10000".to_owned()),
    }
}
