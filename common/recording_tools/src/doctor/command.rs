//! The command `backcast doctor`.

use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Duration;

use command_line::LOST_DATA;
use offline::TopicOptions;
use schemars::JsonSchema;
use serde::Serialize;

use super::bands;
use super::checks;
use super::finding::{Finding, Severity};
use super::located;
use super::survey::Survey;
use crate::each::each;

/// Text below the options in the help.
pub const NOTES: &str = "\
Exit codes: 0 nothing but notes, 1 there are problems, 2 wrong use, 3 data was lost";

/// Options of `backcast doctor`.
#[derive(Debug, clap::Args)]
pub struct Config {
    /// The recordings to check: MCAP files, or bags of rosbag2 (their folders, or .db3)
    #[arg(required_unless_present = "ros2", value_name = "FILE")]
    recordings: Vec<PathBuf>,

    /// Check a live ROS 2 robot: record its scans, odometry and map for this many seconds from the
    /// first scan on
    #[arg(
        long,
        value_name = "SECONDS",
        num_args = 0..=1,
        default_missing_value = "20",
        conflicts_with = "recordings",
        value_parser = clap::value_parser!(u16).range(1..=3600)
    )]
    ros2: Option<u16>,

    /// With --ros2: address of the robot's Zenoh router, such as tcp/192.168.0.5:7447 [default: the
    /// robot is searched for on DDS and Zenoh]
    #[arg(long, value_name = "ROUTER", requires = "ros2")]
    connect: Option<String>,

    /// The map to compare scans with: a YAML file in the format of map_server, or another recording
    /// that contains one [default: in the recording]
    #[arg(long, value_name = "FILE")]
    map: Option<PathBuf>,

    #[command(flatten)]
    topics: TopicOptions,

    /// Print JSON, one object per file
    #[arg(long)]
    json: bool,
}

/// Findings for one file.
#[derive(Debug, Serialize, JsonSchema)]
pub(crate) struct Report {
    recording: String,
    findings: Vec<Finding>,
}

impl Config {
    /// Router of a live robot to record, if given, and the duration of the recording.
    pub fn live(&self) -> Option<(Option<&str>, Duration)> {
        let seconds = u64::from(self.ros2?);
        Some((self.connect.as_deref(), Duration::from_secs(seconds)))
    }
}

pub fn run(config: &Config) -> anyhow::Result<ExitCode> {
    examine(config, &config.recordings, &[])
}

/// Checks the recording of a live robot; `warnings` are known faults that the recording does not
/// show.
pub fn run_on<'a>(
    config: &Config,
    recording: &Path,
    warnings: impl IntoIterator<Item = &'a String>,
) -> anyhow::Result<ExitCode> {
    let warnings: Vec<Finding> = warnings.into_iter().map(Finding::problem).collect();
    examine(config, &[recording.to_owned()], &warnings)
}

fn examine(config: &Config, recordings: &[PathBuf], known: &[Finding]) -> anyhow::Result<ExitCode> {
    let map = config.map.as_ref().map(|file| {
        let options = located::options().with_map(file);
        options.load_map(recordings)
    });
    let map = map.transpose()?.flatten();
    let mut worst = Severity::Note;
    let any_failed = each(recordings, &config.topics, |path, mut recording| {
        let survey = Survey::of(&recording);
        let mut findings = known.to_vec();
        findings.extend(checks::all(&recording, &survey, map.as_ref()));
        // Errors are found by the other checks.
        let band = bands::compare(&mut recording, &config.topics.cloud, map.as_ref());
        findings.extend(band.ok().flatten());
        let severity = findings.iter().map(|finding| finding.severity).max();
        worst = worst.max(severity.unwrap_or(Severity::Note));
        let report = Report {
            recording: match config.ros2 {
                Some(_) => "the robot".to_owned(),
                None => path.display().to_string(),
            },
            findings,
        };
        Ok(match config.json {
            true => command_line::json::object(&report) + "\n",
            false => text(&report),
        })
    })?;
    Ok(match worst {
        _ if any_failed => ExitCode::FAILURE,
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
