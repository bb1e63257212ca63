//! The command `backcast doctor`.

use std::path::PathBuf;
use std::process::ExitCode;

use command_line::{LOST_DATA, stdout};
use offline::TopicOptions;
use recording::Recording;
use serde::Serialize;

use super::checks;
use super::finding::{Finding, Severity};
use super::located;
use super::survey::Survey;
use crate::RecordingToolsError;

/// What stands below the options.
pub const NOTES: &str = "\
Exit codes: 0 nothing but notes, 1 there are problems, 2 wrong use, 3 data was lost";

/// Options of `backcast doctor`.
#[derive(Debug, clap::Args)]
pub struct Config {
    /// The recordings, each by itself: MCAP files, or bags of rosbag2 (their
    /// folders, or .db3)
    #[arg(required = true, value_name = "FILE")]
    recordings: Vec<PathBuf>,

    /// The map to compare scans with, a YAML file as map_server reads it, or another
    /// recording that holds one [default: in the recording]
    #[arg(long, value_name = "FILE")]
    map: Option<PathBuf>,

    #[command(flatten)]
    topics: TopicOptions,

    /// Print JSON, an object a file
    #[arg(long)]
    json: bool,
}

/// What was found in a file.
#[derive(Debug, Serialize)]
struct Report {
    recording: String,
    findings: Vec<Finding>,
}

/// Examines one file after another.
///
/// # Errors
/// A file cannot be read, or is no recording.
pub fn run(config: &Config) -> Result<ExitCode, RecordingToolsError> {
    let map = config.map.as_ref().map(|file| {
        let options = located::options().with_map(file);
        options.load_map(&config.recordings)
    });
    let map = map.transpose()?.flatten();
    let mut worst = Severity::Note;
    for path in &config.recordings {
        let mut recording = Recording::open(path)?;
        config.topics.apply(&mut recording)?;
        let findings = checks::all(&recording, &Survey::of(&recording), map.as_ref());
        let severity = findings.iter().map(|finding| finding.severity).max();
        worst = worst.max(severity.unwrap_or(Severity::Note));
        let report = Report {
            recording: path.display().to_string(),
            findings,
        };
        stdout::print(&match config.json {
            true => json::object(&report) + "\n",
            false => text(&report),
        })?;
    }
    Ok(match worst {
        Severity::Note => ExitCode::SUCCESS,
        Severity::Problem => ExitCode::FAILURE,
        Severity::Lost => ExitCode::from(LOST_DATA),
    })
}

fn text(report: &Report) -> String {
    let Report {
        recording,
        findings,
    } = report;
    if findings.is_empty() {
        return format!("{recording}: sound\n");
    }
    let lines = findings.iter().map(|finding| format!("{finding}\n"));
    format!("{recording}:\n{}", lines.collect::<String>())
}
