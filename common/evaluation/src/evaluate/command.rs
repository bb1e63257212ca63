//! The command `backcast evaluate`.

use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::slice;

use anyhow::Context;
use command_line::{number, say, stdout, wrong_use};
use map::OccupancyGrid;
use offline::{Accepted, Options, Progress, Session, World, no_truth_taken};

use super::answers::{self, AnswerOptions};
use super::judge::{Evaluation, Judged, Total, complaint};
use super::limits::Limits;
use super::memory;
use super::table::Table;
use crate::outcomes::{ReportOptions, total_line};
use crate::sequence::{self, SequenceOptions, Task};
use crate::trust;
use crate::truths::{TruthOptions, Truths};

pub const NOTES: &str = "\
Shares are of the truths: the scans taken that have a true pose. Only those are searched.
cpu is of one thread from the scan to the verdict, decoding excluded; prepare is of the map.
Errors are of the answers within 0.5 m and 10 degrees, which are the right ones.
ellipse is of the unique ones: the true position lies in the ellipse of 95 %.
Of several files, a last line has the total: of all scans, the largest map and peak of memory.
Below, the probabilities of the best places of all files, and how many of those were right.

Exit codes: 0 all evaluated, 1 a file could not be or misses a requirement, 2 wrong use";

/// Options of `backcast evaluate`.
#[derive(Debug, Clone, clap::Args)]
#[command(mut_args(answers::refuse_beside_answers))]
pub struct Config {
    /// Recordings with true poses on /ground_truth, evaluated one by one: MCAP files, or bags of
    /// rosbag2 (their folders, or .db3); a map among them is taken for that of --map
    #[arg(required_unless_present = "stress", value_name = "FILE")]
    bags: Vec<PathBuf>,

    #[command(flatten)]
    report: ReportOptions,

    #[command(flatten)]
    truths: TruthOptions,

    /// Erase the map around each true pose: cells within this distance become unknown, metres,
    /// 0..=1000. unique_wrong then shows how often a place that is missing on the map is mistaken
    /// for another
    #[arg(long, value_name = "METRES", value_parser = number(0.0..=1000.0, "metres"))]
    erase_place: Option<f64>,

    #[command(flatten)]
    answers: AnswerOptions,

    #[command(flatten)]
    limits: Limits,

    #[command(flatten)]
    options: Options,

    #[command(flatten)]
    sequence: SequenceOptions,
}

/// Evaluates the files; one that cannot be evaluated is reported, and the next one follows.
pub fn run(config: &Config) -> anyhow::Result<ExitCode> {
    let (options, bags) = config.options.sorted(&config.bags);
    let config = &Config {
        options,
        bags,
        ..config.clone()
    };
    config.options.check()?;
    let mut bags = config.bags.clone();
    bags.splice(0..0, config.sequence.stressed_file());
    if bags.is_empty() {
        return Err(wrong_use("--stress needs a recording"));
    }
    if let Some(file) = &config.answers.answers {
        return judge_answers(file, config);
    }
    let map = config.options.load_map(&config.bags)?;
    let mut outcomes = config.report.outcomes()?;
    if config.sequence.sequence {
        let task = Task {
            bags: &bags,
            map: map.as_ref(),
            options: &config.options,
            sequence: &config.sequence,
            truths: &config.truths,
            report: &config.report,
        };
        sequence::evaluate(&task, &mut outcomes)?;
        return outcomes.finish();
    }
    let (json, table) = (config.report.json, Table::of(&config.bags));
    let mut total = Total::default();
    for (index, bag) in config.bags.iter().enumerate() {
        let name = bag.display().to_string();
        if let Err(error) = memory::forget_peak()
            && index > 0
        {
            say(&format!(
                "{name}: peak_rss_mb is that of all files so far: {error}"
            ));
        }
        let (judged, costs) = match evaluate(bag, config, map.as_ref()) {
            Ok(judged) => judged,
            Err(error) => {
                outcomes.failed(&name, &error, say);
                continue;
            }
        };
        let evaluation = costs.with(slice::from_ref(&judged));
        total.add(judged, &evaluation);
        if !config.report.total {
            outcomes.judged(&name, None, &config.missed(&evaluation), say);
        }
        stdout::print(&match json {
            true => command_line::json::object(&evaluation) + "\n",
            false if total.files.len() == 1 => table.header() + &table.row(&evaluation),
            false => table.row(&evaluation),
        })?;
    }
    let all = total.conclude();
    if config.report.total {
        outcomes.judged("total", None, &config.missed(&all), say);
    }
    if total.files.len() > 1 {
        stdout::print(&match json {
            true => total_line(&all),
            false => table.row(&all),
        })?;
    }
    if !json && !total.files.is_empty() {
        stdout::print(&format!("\n{}", trust::table(&all.probabilities)))?;
    }
    outcomes.finish()
}

impl Config {
    fn missed(&self, found: &Evaluation) -> Vec<String> {
        let truths = self.truths.missed(found.truths).into_iter();
        truths.chain(self.limits.missed(found)).collect()
    }
}

/// Judges the answers of another program to one recording, and prints the figures.
fn judge_answers(file: &Path, config: &Config) -> anyhow::Result<ExitCode> {
    let [bag] = &config.bags[..] else {
        let files = config.bags.len();
        return Err(wrong_use(format!(
            "--answers are those to one recording; {files} are given"
        )));
    };
    let mut outcomes = config.report.outcomes()?;
    let options = (&config.answers, &config.truths, &config.options);
    match answers::evaluate(file, bag, options) {
        Ok((figures, reached)) => {
            stdout::print(&match config.report.json {
                true => command_line::json::object(&figures) + "\n",
                false => figures.text(),
            })?;
            let missed = config.missed(&reached);
            outcomes.judged(&bag.display().to_string(), None, &missed, say);
        }
        Err(error) => outcomes.failed(&bag.display().to_string(), &error, say),
    }
    outcomes.finish()
}

fn evaluate(
    bag: &Path,
    config: &Config,
    map: Option<&OccupancyGrid>,
) -> anyhow::Result<(Vec<Judged>, Evaluation)> {
    let (recording, truths) = config.truths.open(bag, &config.options)?;
    let mut session = Session::open(&recording, &config.options, map)?;
    let name = bag.display().to_string();
    let progress = Progress::new(&name, session.scans.total());
    let (judged, scans) = judge_all(&mut session, &truths, (bag, config), &progress)?;
    if let Some(complaint) = complaint(&judged) {
        progress.say(&format!("{name}: {complaint}"));
    }
    if judged.is_empty() {
        return Err(no_truth_taken(bag, scans, truths.recorded()));
    }
    let costs = Evaluation {
        bag: name,
        map_cells: session.world().map_or(0, World::cells),
        scans,
        prepare_cpu_ms: session.prepare_cpu_ms,
        peak_rss_mb: memory::peak_mb()
            .context("cannot read the peak of memory from /proc/self/status")?,
        searchable_cells: session.world().map_or(0, World::searchable_cells),
        index_bytes: session.world().map_or(0, World::index_bytes),
        ..Evaluation::default()
    };
    Ok((judged, costs))
}

/// Judges the scans with a true pose; also counts those read.
fn judge_all(
    session: &mut Session<'_>,
    truths: &Truths,
    (bag, config): (&Path, &Config),
    progress: &Progress,
) -> anyhow::Result<(Vec<Judged>, u64)> {
    let (mut judged, mut scans) = (Vec::new(), 0);
    let mut accepted = Accepted::default();
    while let Some(scan) = session.scans.next() {
        let scan = scan?;
        scans += 1;
        if let Some(truth) = truths.at(scan.stamp_ns) {
            if let Some(radius_m) = config.erase_place {
                session.erase(&scan, truth, radius_m)?;
            }
            let reply = session.ask(&scan)?;
            accepted.count(&reply);
            judged.push(match reply.answer {
                Ok(answer) => Judged::answer(truth, answer.places, reply.cpu_ms),
                Err(refusal) => Judged::refusal(truth, format!("{refusal:#}")),
            });
        }
        for note in session.take_notes() {
            progress.say(&note);
        }
        progress.step();
    }
    accepted.check(bag)?;
    Ok((judged, scans))
}
