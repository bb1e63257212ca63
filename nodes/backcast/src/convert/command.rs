//! What `backcast convert` does.

use std::fs::File;
use std::io::{BufReader, BufWriter, Write};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use recording::write::{Packing, RecordingWriter};
use recording::{Kind, Recording, is_bag};

use super::{to_carmen, to_recording};
use crate::BackcastError;
use crate::cli::LOST_DATA;
use crate::offline::say;

/// What stands below the options.
pub(crate) const NOTES: &str = "\
.log and .clf are CARMEN's laser logs, .mcap a recording with ROS 2 messages, .db3 (or a folder of
such) a bag of rosbag2 in SQLite, of which all topics are converted.

Exit codes: 0 done, 1 failed, 2 wrong use, 3 done but something could not be read";

/// What `backcast convert` takes.
#[derive(Debug, clap::Args)]
pub(crate) struct Config {
    /// The file to read: .log, .clf, .mcap or .db3, or the folder of a bag
    #[arg(value_name = "FROM")]
    from: PathBuf,

    /// The file to write: .mcap, or .log
    #[arg(value_name = "TO")]
    to: PathBuf,

    /// The log's laser poses were corrected: make them /ground_truth
    #[arg(long)]
    truth: bool,

    /// Readings above are no returns, metres, where the log does not say
    #[arg(long, value_name = "METRES", default_value_t = 80.0, value_parser = range)]
    range_max: f32,
}

fn range(text: &str) -> Result<f32, String> {
    match text.parse() {
        Ok(range) if (0.1..=10_000.0).contains(&range) => Ok(range),
        _ => Err("allowed are 0.1 to 10000 m".to_owned()),
    }
}

/// How a log is understood.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Rules {
    /// Whether laser poses are true ones.
    pub(super) truth: bool,
    pub(super) range_max_m: f32,
}

/// What was converted.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub(super) struct Report {
    pub(super) scans: u64,
    pub(super) odometry: u64,
    /// Lines of kinds that are not converted.
    pub(super) left_out: u64,
    /// What could not be read, and why the first could not.
    pub(super) refused: u64,
    pub(super) first_refusal: Option<String>,
    /// Scans whose laser sits elsewhere than that of the first one.
    pub(super) moved_mounts: u64,
}

/// Converts one file.
///
/// # Errors
/// The files' kinds do not go together, one cannot be read or written, or the
/// one to write exists.
pub(crate) fn run(config: &Config) -> Result<ExitCode, BackcastError> {
    let from = match is_bag(&config.from) {
        true => "db3",
        false => kind(&config.from),
    };
    let report = match (from, kind(&config.to)) {
        ("log" | "clf", "mcap") => log_to_recording(config)?,
        ("mcap" | "db3", "log" | "clf") => recording_to_log(config)?,
        ("db3", "mcap") => bag_to_recording(config)?,
        (from, to) => {
            return Err(BackcastError::Usage(format!(
                "from .{from} to .{to} is no conversion; allowed are .log, .clf and .db3 to \
                 .mcap, and .mcap and .db3 to .log"
            )));
        }
    };
    let Report {
        scans, odometry, ..
    } = report;
    let to = config.to.display();
    say(&format!(
        "{to}: {scans} scans, {odometry} poses of the odometry"
    ));
    if report.moved_mounts > 0 {
        say(&format!(
            "{} scans were taken where the laser sat elsewhere than at first; poses that were \
             corrected need --truth",
            report.moved_mounts
        ));
    }
    match report.first_refusal {
        None => Ok(ExitCode::SUCCESS),
        Some(refusal) => {
            say(&format!("{} could not be read; {refusal}", report.refused));
            Ok(ExitCode::from(LOST_DATA))
        }
    }
}

fn kind(path: &Path) -> &str {
    path.extension()
        .and_then(|kind| kind.to_str())
        .unwrap_or_default()
}

fn log_to_recording(config: &Config) -> Result<Report, BackcastError> {
    let log = File::open(&config.from).map_err(failed("read", &config.from))?;
    let rules = Rules {
        truth: config.truth,
        range_max_m: config.range_max,
    };
    let mut writer = RecordingWriter::new(create(&config.to)?, Packing::Zstd)?;
    let report = to_recording::convert(BufReader::new(log), &rules, &mut writer)?;
    writer
        .finish()?
        .flush()
        .map_err(failed("write", &config.to))?;
    Ok(report)
}

fn recording_to_log(config: &Config) -> Result<Report, BackcastError> {
    let recording = Recording::open(&config.from)?;
    let mut log = create(&config.to)?;
    let converted = to_carmen::convert(&recording, &mut log);
    log.flush().map_err(failed("write", &config.to))?;
    converted
}

fn bag_to_recording(config: &Config) -> Result<Report, BackcastError> {
    let mut writer = RecordingWriter::new(create(&config.to)?, Packing::Zstd)?;
    let messages = recording::write_bag(&config.from, &mut writer)?;
    writer
        .finish()?
        .flush()
        .map_err(failed("write", &config.to))?;
    say(&format!("{messages} messages of all topics"));
    // Read again, which also tells whether it can be.
    let recording = Recording::open(&config.to)?;
    let of = |kind| {
        let channels = recording.channels().filter(|c| c.kind == Some(kind));
        channels.map(|channel| channel.messages).sum()
    };
    Ok(Report {
        scans: of(Kind::Scan),
        odometry: of(Kind::Odometry),
        ..Report::default()
    })
}

fn create(path: &Path) -> Result<BufWriter<File>, BackcastError> {
    File::create_new(path)
        .map(BufWriter::new)
        .map_err(failed("create", path))
}

fn failed<'p>(
    action: &'static str,
    path: &'p Path,
) -> impl FnOnce(std::io::Error) -> BackcastError + 'p {
    move |source| BackcastError::File {
        action,
        file: path.to_owned(),
        source,
    }
}
