//! Options and entry point of `backcast soak`.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Duration;

use anyhow::{Context, bail};
use command_line::{output, stdout::print, wrong_use};
use dataflow::RestartPolicy;
use geometry::Pose;
use launcher::descriptor::{self, Builds, DEFAULT_FILE, Descriptor};
use launcher::run::Options;
use launcher::run::arguments::{MAP_SERVER, PLAYERS, value};
use recording::Recording;
use transport::GraphName;

use super::course::{Course, Plan};
use super::fault::Fault;
use super::filler;
use super::maps::Maps;

/// Notes below the options in the help text.
pub const NOTES: &str = "\
A recording is played again and again, and every pose that the tracker is sure of is
compared with the recording's /ground_truth. What the graph itself says goes to standard
error, the report to standard output.

shm and disk fill a file system, and are refused where more than 1 GiB is free: give the
graph its own, as root, or with --user --map-root-user:

    unshare --mount sh -c 'mount -t tmpfs -o size=256m tmpfs /dev/shm && backcast soak …'

Exit codes: 0 all guarantees were met, 1 a pose was wrong, something did not recover or was left
behind, 2 wrong use";

const DEFAULT_FAULTS: [Fault; 4] = [Fault::Kill, Fault::Pair, Fault::Stop, Fault::Map];
/// Duration of a part of the recording.
const PART: &str = "5m";
const DEFAULT_MINUTES: f64 = 60.0;

/// Options of `backcast soak`.
#[derive(Debug, clap::Args)]
pub struct Config {
    /// Descriptor of the graph
    #[arg(default_value = DEFAULT_FILE, value_name = "FILE")]
    dataflow: PathBuf,

    /// Duration in hours [default: 1]
    #[arg(long, value_name = "H", value_parser = positive, conflicts_with = "minutes")]
    hours: Option<f64>,

    /// Duration in minutes
    #[arg(long, value_name = "M", value_parser = positive)]
    minutes: Option<f64>,

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

    /// Print JSON
    #[arg(long)]
    json: bool,
}

/// Runs a graph, injects faults, and prints a report.
///
/// # Errors
/// The graph cannot be set up, or a fault cannot be injected.
pub fn run(config: &Config) -> anyhow::Result<ExitCode> {
    transport::node::start_logging().map_err(wrong_use)?;
    let descriptor = descriptor::load(&config.dataflow, Builds::Run)?;
    let recording = config.recording(&descriptor)?;
    let truths = truths(&recording)?;
    check_room(config)?;
    let folder = tempfile::tempdir().with_context(|| {
        let folder = std::env::temp_dir();
        format!("cannot create a folder in {}", folder.display())
    })?;
    let maps = Maps::new(&config.map(&descriptor)?, folder.path())?;
    let graph = match &config.graph {
        Some(graph) => graph.clone(),
        None => Options::default().graph_name()?,
    };
    let plan = Plan {
        arguments: config.arguments(&graph, &maps),
        victims: victims(&descriptor),
        graph,
        lasts: config.lasts(),
        pause: Duration::from_secs_f64(config.pause),
        faults: config.faults.clone(),
        seed: config.seed,
        record: config.record.clone(),
    };
    let report = Course::start(plan, maps, truths)?.run()?;
    print(&match config.json {
        true => report.json(),
        false => report.text(),
    })?;
    Ok(match report.is_good() {
        true => ExitCode::SUCCESS,
        false => ExitCode::FAILURE,
    })
}

impl Config {
    fn lasts(&self) -> Duration {
        let minutes = self.hours.map(|hours| 60.0 * hours).or(self.minutes);
        Duration::from_secs_f64(60.0 * minutes.unwrap_or(DEFAULT_MINUTES))
    }

    /// Arguments for the launcher, after `run`.
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

    fn recording(&self, descriptor: &Descriptor) -> anyhow::Result<PathBuf> {
        match &self.replay {
            Some(file) => Ok(file.clone()),
            None => named(descriptor, &PLAYERS, "--recording", "--replay"),
        }
    }

    fn map(&self, descriptor: &Descriptor) -> anyhow::Result<PathBuf> {
        match &self.map {
            Some(file) => Ok(file.clone()),
            None => named(descriptor, &[MAP_SERVER], "--map", "--map"),
        }
    }
}

/// File that the descriptor gives to one of these nodes; the error asks for option `instead`.
fn named(
    descriptor: &Descriptor,
    executables: &[&str],
    option: &str,
    instead: &str,
) -> anyhow::Result<PathBuf> {
    let mut nodes = descriptor.dataflow.nodes.iter();
    let node = nodes.find(|node| executables.contains(&node.executable()));
    match node.and_then(|node| value(node, option)) {
        Some(file) => Ok(descriptor.folder.join(file)),
        None => Err(wrong_use(format!(
            "{} has no {} with {option}: say which one with {instead}",
            descriptor.file.display(),
            executables.join(" or "),
        ))),
    }
}

/// Nodes that can be killed and stopped: those that are restarted.
fn victims(descriptor: &Descriptor) -> Vec<String> {
    let nodes = descriptor.dataflow.nodes.iter();
    let again = nodes.filter(|node| node.restart.policy != RestartPolicy::Never);
    again.map(|node| node.id.clone()).collect()
}

fn truths(recording: &Path) -> anyhow::Result<BTreeMap<i64, Pose>> {
    let truths = Recording::open(recording)?.ground_truths()?;
    if truths.is_empty() {
        let file = recording.display();
        bail!("{file} has no true poses on /ground_truth: nothing to compare with");
    }
    let pose = |(stamp_ns, truth): (i64, recording::GroundTruth)| (stamp_ns, truth.pose);
    Ok(truths.into_iter().map(pose).collect())
}

/// Checks that the file systems to be filled are small enough.
fn check_room(config: &Config) -> anyhow::Result<()> {
    if config.faults.contains(&Fault::Shm) {
        filler::check(Path::new("/dev/shm"))?;
    }
    if config.faults.contains(&Fault::Disk) {
        let Some(record) = &config.record else {
            let needed = "--faults disk fills the disk of --record, which is not given";
            return Err(wrong_use(needed));
        };
        filler::check(output::folder_of(record))?;
    }
    Ok(())
}

fn positive(text: &str) -> Result<f64, String> {
    match text.parse() {
        // More than a year, but no overflow of any clock.
        Ok(value) if value > 0.0 && value <= 1e4 => Ok(value),
        _ => Err("allowed is a number above 0, up to 10000".to_owned()),
    }
}
