//! The command `backcast regress`.

use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Instant;

use anyhow::anyhow;
use command_line::{say, stdout, wrong_use};
use launcher::descriptor::{self, Builds, DEFAULT_FILE};
use launcher::run::build;
use transport::GraphName;

use super::case::{self, Case};
use super::compare::{Tolerance, differences, summary, table};
use super::outcome::{Object, Outcome};
use super::play;
use crate::outcomes::Outcomes;

pub const NOTES: &str = "\
A case is a folder with recording.mcap (or the folder recording, of a bag), expected.json, and
map.yaml unless the recording holds the map. With --tolerance exact, votes, verdicts, the tracker's states and counts must
come out exactly; positions within 1 mm, headings within 0.01 degrees, scores within 0.001.
With --tolerance pose, verdicts and states must, and where both are Unique the pose within
5 cm and 1 degree: what a robot would notice of another version of the engine. One that has become
Unique is as good where /ground_truth of its scan is within 0.5 m and 10 degrees.

Exit codes: 0 all as expected or accepted, 1 differences, a graph that fails or a recording that is
damaged, 2 wrong use";

/// Options of `backcast regress`.
#[derive(Debug, clap::Args)]
pub struct Config {
    /// Folders that are cases, or contain cases
    #[arg(default_value = "recordings", value_name = "FOLDER")]
    folders: Vec<PathBuf>,

    /// The graph that plays each recording on its map, at --rate max
    #[arg(long, default_value = DEFAULT_FILE, value_name = "FILE")]
    dataflow: PathBuf,

    /// Differences to report
    #[arg(long, value_enum, default_value_t = Tolerance::Exact)]
    tolerance: Tolerance,

    /// Accept the results as the new expectation, and print a summary of the changes
    #[arg(long)]
    accept: bool,

    /// Write a JUnit report for a build server: a suite per recording, a test case per scan
    #[arg(long, value_name = "FILE")]
    junit: Option<PathBuf>,

    /// Overwrite the file of --junit
    #[arg(long, requires = "junit")]
    force: bool,

    /// Print JSON, one object per recording
    #[arg(long)]
    json: bool,
}

impl Config {
    /// Names the command that writes the expectation of a case.
    fn hint(&self, case: &Case) -> String {
        let graph = match self.dataflow == Path::new(DEFAULT_FILE) {
            true => String::new(),
            false => format!(" --dataflow {}", self.dataflow.display()),
        };
        let folder = case.folder.display();
        format!("`backcast regress {folder}{graph} --accept` writes it")
    }
}

/// Replays the recordings; one whose graph fails is reported, and the next one follows.
pub fn run(config: &Config) -> anyhow::Result<ExitCode> {
    transport::node::start_logging().map_err(wrong_use)?;
    let mut outcomes = Outcomes::new("backcast regress", config.junit.as_ref(), config.force)?;
    let cases = case::all_in(&config.folders)?;
    let mut descriptor = descriptor::load(&config.dataflow, Builds::Run)?;
    // The replayer is the same for all cases, and is built with the other nodes.
    if let Some(case) = cases.first() {
        play::direct(&mut descriptor, case)?;
    }
    build::build_all(&descriptor.dataflow, &descriptor.folder)?;
    for case in &cases {
        let outcome = replay(config, case);
        stdout::print(&match config.json {
            true => command_line::json::object(&Object::of(&outcome, config.accept)) + "\n",
            false => text(&outcome, config.accept),
        })?;
        outcome.add_to(&mut outcomes, config.accept);
    }
    outcomes.finish()
}

fn replay(config: &Config, case: &Case) -> Outcome {
    let start = Instant::now();
    let mut outcome = Outcome {
        name: case.name.clone(),
        scans: Vec::new(),
        took: start.elapsed(),
        result: Ok(Vec::new()),
    };
    if let Err(error) = judge(config, case, &mut outcome) {
        say(&format!("{}: {error:#}", case.name));
        outcome.result = Err(format!("{error:#}"));
    }
    outcome.took = start.elapsed();
    outcome
}

fn judge(config: &Config, case: &Case, outcome: &mut Outcome) -> anyhow::Result<()> {
    let expected = case.expected();
    let mut descriptor = descriptor::load(&config.dataflow, Builds::Run)?;
    play::direct(&mut descriptor, case)?;
    let name = GraphName::new(&format!("rg{}", std::process::id()))?;
    let played = play::play(descriptor, &name, &case.recording())?;
    let found = &played.answers;
    outcome.scans = found.iter().map(|answer| answer.stamp_ns).collect();
    // With `--accept` an unreadable expectation is overwritten.
    let expected = match config.accept {
        true => Some(expected.ok().flatten().unwrap_or_default()),
        false => expected.map_err(|error| anyhow!("{error:#}; {}", config.hint(case)))?,
    };
    let Some(mut expected) = expected else {
        outcome.result = Err(format!("there is no expected.json; {}", config.hint(case)));
        return Ok(());
    };
    if !played.is_tracked {
        // A graph without a tracker has no poses to compare.
        for answer in &mut expected {
            answer.values.remove("pose");
        }
    }
    let all = differences(&expected, found, config.tolerance, &played.truths);
    if let Some(damage) = played.damage {
        // Accepting a truncated replay would drop the expectations of the missing scans.
        outcome.result = Err(format!(
            "{damage}; only what lies before was played and compared, with {} differences",
            all.len()
        ));
        return Ok(());
    }
    outcome.result = Ok(all);
    match config.accept {
        true => case.accept(found),
        false => Ok(()),
    }
}

fn text(outcome: &Outcome, accepted: bool) -> String {
    let (name, scans) = (&outcome.name, outcome.scans.len());
    let seconds = outcome.took.as_secs_f64();
    let word = match (&outcome.result, accepted) {
        (Ok(_), true) => "accepted: ",
        _ => "",
    };
    let verdict = outcome
        .complaint()
        .unwrap_or_else(|| "as expected".to_owned());
    let line = format!("{name}: {scans} scans in {seconds:.1} s, {word}{verdict}\n");
    match &outcome.result {
        Ok(differences) if accepted => line + &summary(differences),
        Ok(differences) if !differences.is_empty() => line + &table(differences),
        _ => line,
    }
}
