//! Command-line options.

use std::path::PathBuf;

use clap::Parser;
use command_line::number;
use command_line::settings::{self, SettingsFile};
use engine::beams::BeamConfig;
use engine::fit::FitConfig;
use engine::joined::JoinConfig;
use engine::settings::{fit_id, reading_id};
use engine::tracking::TrackingConfig;
use geometry::Pose;

/// Tracks the robot's pose from scans, odometry and search results, and publishes it as `pose`.
#[derive(Debug, Clone, Parser)]
#[command(name = "tracker", version)]
pub struct Config {
    #[command(flatten)]
    pub file: SettingsFile,

    #[command(flatten)]
    pub tracking: TrackingConfig,

    /// Maximum number of poses per second, 0..=1000: between scans, the pose is extrapolated by
    /// odometry. 0 sends one pose per scan only.
    #[arg(long, value_name = "HERTZ", default_value_t = 50.0, allow_negative_numbers = true, value_parser = number(0.0..=1000.0, "poses a second"))]
    pub rate: f64,

    /// File in which the last pose is saved, and from which it is tried first after a start. It is
    /// not used before scans confirm it.
    #[arg(long, value_name = "FILE")]
    pub remember: Option<PathBuf>,

    /// Initial pose in the map: metres, metres and degrees. It is tried first, and not used before
    /// a scan confirms it.
    #[arg(long, value_name = "X,Y,DEGREES", allow_hyphen_values = true, value_parser = pose)]
    pub initial_pose: Option<Pose>,

    #[command(flatten)]
    pub join: JoinConfig,

    #[command(flatten)]
    pub beams: BeamConfig,

    #[command(flatten)]
    pub fit: FitConfig,
}

impl Config {
    pub fn from_command_line() -> Self {
        settings::parse(|config: &Config| &config.file, |_| Ok(()))
    }

    /// Id of the settings by which this node reads scans and compares them with the map.
    pub(crate) fn settings(&self) -> u64 {
        fit_id(reading_id(&self.join, &self.beams), &self.fit)
    }
}

fn pose(text: &str) -> Result<Pose, String> {
    let numbers: Result<Vec<f64>, _> = text.split(',').map(|part| part.trim().parse()).collect();
    match numbers.as_deref() {
        Ok(&[x, y, degrees]) if [x, y, degrees].iter().all(|n| n.is_finite()) => {
            Ok(Pose::new(x, y, degrees.to_radians()))
        }
        _ => Err("allowed are three numbers: metres, metres and degrees".into()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parse(arguments: &str) -> Result<Config, String> {
        let words = ["tracker"].into_iter().chain(arguments.split_whitespace());
        Config::try_parse_from(words).map_err(|error| error.to_string())
    }

    #[test]
    fn settings_have_defaults_and_limits() {
        let config = parse("").unwrap();
        assert_eq!(config.tracking, TrackingConfig::default());
        assert_eq!((config.rate, config.initial_pose), (50.0, None));
        let pose = parse("--initial-pose -1,2,90")
            .unwrap()
            .initial_pose
            .unwrap();
        assert!(pose.is_within(
            Pose::new(-1.0, 2.0, std::f64::consts::FRAC_PI_2),
            1e-9,
            1e-9
        ));
        for (wrong, allowed) in [
            ("--rate -1", "0 to 1000"),
            ("--initial-pose 1,2", "three numbers"),
            ("--initial-pose 1,2,NaN", "three numbers"),
            ("--scan-cap 101", "0 to 100"),
        ] {
            let text = parse(wrong).unwrap_err();
            assert!(text.contains(allowed), "{wrong}: {text}");
        }
    }
}
