//! Options of `backcast evaluate --sequence`.

use std::path::PathBuf;

use anyhow::Context;
use command_line::{number, output};
use engine::tracking::TrackingConfig;
use map::OccupancyGrid;
use offline::Options;

use super::course;
use super::limits::SequenceLimits;
use super::stress::Stress;
use crate::outcomes::ReportOptions;
use crate::truths::TruthOptions;

pub(crate) struct Task<'a> {
    pub(crate) bags: &'a [PathBuf],
    /// The map, unless it is that of each recording.
    pub(crate) map: Option<&'a OccupancyGrid>,
    pub(crate) options: &'a Options,
    pub(crate) sequence: &'a SequenceOptions,
    pub(crate) truths: &'a TruthOptions,
    pub(crate) report: &'a ReportOptions,
}

/// Options of `backcast evaluate --sequence`.
#[derive(Debug, Clone, clap::Args)]
#[command(next_help_heading = "Sequences")]
pub(crate) struct SequenceOptions {
    /// Track the pose over each recording: from many starts, after moving the robot elsewhere
    /// ("kidnapped"), and over the whole drive
    #[arg(long)]
    pub sequence: bool,

    /// Number of starts, spread over the recording, 1..=1000
    #[arg(long, value_name = "COUNT", default_value_t = 80, value_parser = clap::value_parser!(u32).range(1..=1000))]
    pub starts: u32,

    /// Number of times that the robot is moved elsewhere, 0..=1000
    #[arg(long, value_name = "COUNT", default_value_t = 20, value_parser = clap::value_parser!(u32).range(0..=1000))]
    pub kidnaps: u32,

    /// Number of outages: no data for 0.5 to 4 s, then odometry that starts again, 0..=1000
    #[arg(long, value_name = "COUNT", default_value_t = 20, value_parser = clap::value_parser!(u32).range(0..=1000))]
    pub outages: u32,

    /// Ignore the odometry
    #[arg(long)]
    pub without_odometry: bool,

    /// Multiply the errors of odometry, against the truth, by this factor, 0..=100
    #[arg(long, value_name = "FACTOR", default_value_t = 1.0, value_parser = number(0.0..=100.0, "times"))]
    pub odometry_noise: f64,

    /// Numbers of scans, from 0, whose true poses are known to be wrong
    #[arg(long, value_name = "N,N", value_delimiter = ',')]
    pub ignore_truth: Vec<u64>,

    /// Write the tracked and the true trajectory of each drive, from its first scan without an
    /// initial pose, to this folder: in the formats TUM and KITTI, which evo reads, and as CSV
    #[arg(long, value_name = "FOLDER", requires = "sequence")]
    pub trajectories: Option<PathBuf>,

    /// Draw each drive into this folder: the map, the path, and where the pose was not unique
    #[arg(long, value_name = "FOLDER", requires = "sequence")]
    pub pictures: Option<PathBuf>,

    /// Evaluate variants of each drive in place of the drive: map, scans, odometry or motion are
    /// changed in memory. A comma-separated list of names, or of the groups map, laser, odometry
    /// and motion
    #[arg(long, value_name = "LIST", num_args = 0..=1, default_missing_value = "all", requires = "sequence", conflicts_with_all = ["without_odometry", "odometry_noise"])]
    pub stress: Option<Stress>,

    /// Seed of the variants
    #[arg(long, value_name = "NUMBER", default_value_t = 1, requires = "stress")]
    pub seed: u64,

    /// The map of another building, a YAML file or a recording, for the variant map-other [default:
    /// the map of the next recording]
    #[arg(long, value_name = "FILE", requires = "stress")]
    pub other_map: Option<PathBuf>,

    #[command(flatten)]
    pub limits: SequenceLimits,

    #[command(flatten)]
    pub tracking: TrackingConfig,
}

impl SequenceOptions {
    /// Makes the folders, and checks that the files of these drives can be written there.
    pub(super) fn prepare(&self, names: &[String], force: bool) -> anyhow::Result<()> {
        for folder in self.trajectories.iter().chain(&self.pictures) {
            output::make_folder(folder)
                .with_context(|| format!("cannot make the folder {}", folder.display()))?;
        }
        let (lines, drawn): (&[&str], Vec<String>) = match &self.stress {
            None => (&course::ENDINGS, vec![".png".to_owned()]),
            Some(stress) => {
                let variants = stress.variants().into_iter();
                (
                    &[],
                    variants.map(|it| format!("_{}.png", it.name)).collect(),
                )
            }
        };
        let drawn: Vec<&str> = drawn.iter().map(String::as_str).collect();
        for (folder, endings) in [(&self.trajectories, lines), (&self.pictures, &drawn[..])] {
            if let Some(folder) = folder {
                for name in names {
                    for ending in endings {
                        output::prepare(&folder.join(format!("{name}{ending}")), force)?;
                    }
                }
            }
        }
        Ok(())
    }

    /// The recording, if `--stress` took one as its list.
    pub(crate) fn stressed_file(&self) -> Option<PathBuf> {
        match &self.stress {
            Some(Stress::AllOf(file)) => Some(file.clone()),
            _ => None,
        }
    }
}
