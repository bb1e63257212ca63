//! The command `backcast evaluate`.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use anyhow::Context;
use command_line::{number, stdout, wrong_use};
use map::OccupancyGrid;
use offline::{Accepted, Options, Session, World, no_truth_taken, no_truths};
use progress::{Progress, say};
use recording::GroundTruth;

use super::judge::{Effort, Evaluation, Judge};
use super::limits::Limits;
use super::memory;
use super::table::Table;
use crate::sequence::{self, SequenceOptions};
use crate::trust::Trust;

/// Notes below the options in the help text.
pub const NOTES: &str = "\
Shares are of the truths: the scans taken that have a true pose. Only those are searched.
cpu is of one thread from the scan to the verdict, decoding excluded; prepare is of the map.
Errors are of the answers within 0.5 m and 10 degrees, which are the right ones.
ellipse is of the unique ones: the true position lies in the ellipse of 95 %.
Below, the probabilities of the best places of all files, and how many of those were right.

Exit codes: 0 all evaluated, 1 a file could not be or misses a requirement, 2 wrong use";

/// Options of `backcast evaluate`.
#[derive(Debug, Clone, clap::Args)]
pub struct Config {
    /// Recordings with true poses on /ground_truth, evaluated one by one: MCAP files, or bags of
    /// rosbag2 (their folders, or .db3); a map among them is taken for that of --map
    #[arg(required_unless_present = "stress", value_name = "FILE")]
    bags: Vec<PathBuf>,

    /// Print JSON, one object per file
    #[arg(long)]
    json: bool,

    /// Erase the map around each true pose: cells within this distance become unknown, metres,
    /// 0..=1000. unique_wrong then shows how often a place that is missing on the map is mistaken
    /// for another
    #[arg(long, value_name = "METRES", value_parser = number(0.0..=1000.0, "metres"))]
    erase_place: Option<f64>,

    #[command(flatten)]
    limits: Limits,

    #[command(flatten)]
    options: Options,

    #[command(flatten)]
    sequence: SequenceOptions,
}

/// Evaluates one file after another. A file that cannot be evaluated is reported on standard error,
/// and the next one follows.
///
/// # Errors
/// The options or the given map cannot be used, or output cannot be written.
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
    let map = config.options.load_map(&config.bags)?;
    if config.sequence.sequence {
        let how = (&config.options, &config.sequence);
        return sequence::evaluate(&bags, config.json, map.as_ref(), how);
    }
    let table = Table::of(&config.bags);
    let mut code = ExitCode::SUCCESS;
    let mut trust = Trust::default();
    let mut header = (!config.json).then(|| table.header());
    for (index, bag) in config.bags.iter().enumerate() {
        if let Err(error) = memory::forget_peak()
            && index > 0
        {
            let bag = bag.display();
            say(&format!(
                "{bag}: peak_rss_mb is that of all files so far: {error}"
            ));
        }
        let evaluation = match evaluate(bag, config, map.as_ref(), &mut trust) {
            Ok(evaluation) => evaluation,
            Err(error) => {
                say(&format!("{error:#}"));
                code = ExitCode::FAILURE;
                continue;
            }
        };
        for missed in config.limits.missed(&evaluation) {
            say(&format!("{}: {missed}", bag.display()));
            code = ExitCode::FAILURE;
        }
        let line = match config.json {
            true => json::object(&evaluation),
            false => table.row(&evaluation),
        };
        for line in header.take().into_iter().chain([line]) {
            stdout::print(&format!("{line}\n"))?;
        }
    }
    if !config.json && header.is_none() {
        stdout::print(&format!("\n{trust}"))?;
    }
    Ok(code)
}

/// Evaluates one file, unless it is damaged, and adds its results to `trust`.
fn evaluate(
    bag: &Path,
    config: &Config,
    map: Option<&OccupancyGrid>,
    trust: &mut Trust,
) -> anyhow::Result<Evaluation> {
    let recording = config.options.open(&[bag.to_owned()])?;
    if let Some(damage) = recording.damage_error() {
        return Err(damage.into());
    }
    let truths = recording.ground_truths()?;
    if truths.is_empty() {
        return Err(no_truths(bag));
    }
    let mut session = Session::open(&recording, &config.options, map)?;
    let name = bag.display().to_string();
    let progress = Progress::new(&name, session.scans.total());
    let (judge, accepted, scans) = judge_all(&mut session, &truths, config.erase_place, &progress)?;
    accepted.check(bag)?;
    if let Some(complaint) = judge.complaint() {
        progress.say(&format!("{name}: {complaint}"));
    }
    trust.merge(judge.trust());
    let evaluation = judge.conclude(Effort {
        bag: name,
        map_cells: session.world().map_or(0, World::cells),
        scans,
        prepare_cpu_ms: session.prepare_cpu_ms,
        peak_rss_mb: memory::peak_mb()
            .context("cannot read the peak of memory from /proc/self/status")?,
        searchable_cells: session.world().map_or(0, World::searchable_cells),
        index_bytes: session.world().map_or(0, World::index_bytes),
    });
    match evaluation.truths {
        0 => Err(no_truth_taken(bag, scans, truths.len())),
        _ => Ok(evaluation),
    }
}

/// Searches and judges the scans with a true pose. Also returns the counts of accepted and rejected
/// scans, and the number of scans read.
fn judge_all(
    session: &mut Session<'_>,
    truths: &BTreeMap<i64, GroundTruth>,
    erase_place: Option<f64>,
    progress: &Progress,
) -> anyhow::Result<(Judge, Accepted, u64)> {
    let mut judge = Judge::new();
    let mut accepted = Accepted::default();
    let mut scans = 0;
    while let Some(scan) = session.scans.next() {
        let scan = scan?;
        scans += 1;
        if let Some(truth) = truths.get(&scan.stamp_ns) {
            if let Some(radius_m) = erase_place {
                session.erase(&scan, truth.pose, radius_m)?;
            }
            let reply = session.ask(&scan)?;
            accepted.count(&reply);
            match reply.answer {
                Ok(answer) => judge.answer(truth.pose, answer.places, reply.cpu_ms),
                Err(refusal) => judge.refusal(truth.pose, format!("{refusal:#}")),
            }
        }
        for note in session.take_notes() {
            progress.say(&note);
        }
        progress.step();
    }
    Ok((judge, accepted, scans))
}
