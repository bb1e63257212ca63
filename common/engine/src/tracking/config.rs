//! The settings of the tracker.

#[cfg(feature = "clap")]
use crate::config::{parse, parse_degrees, parse_length, parse_share};

/// When a tracker that knows nothing yet believes a place.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "clap", derive(clap::ValueEnum))]
pub enum Start {
    /// When several key scans agree: the robot has to drive or turn.
    Confirm,
    /// When the verdict on one scan is `Unique`: the robot may stand.
    Believe,
}

/// What the tracker expects of odometry and of scans. docs/tracking.md explains what
/// each setting is for and what becomes of the figures without it.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
pub struct TrackingConfig {
    /// When a tracker that knows nothing yet believes a place.
    #[cfg_attr(
        feature = "clap",
        arg(long, value_name = "WHEN", default_value = "confirm")
    )]
    pub start: Start,
    /// How much odometry errs, against what is usual: a scale of its standard
    /// deviations, 0.1..=10.
    #[cfg_attr(feature = "clap", arg(long, value_name = "FACTOR", default_value_t = 1.0, value_parser = parse_factor))]
    pub odometry_error: f64,
    /// A key scan is taken so far from the one before, metres, 0..=2: places are
    /// weighed against each other at key scans only, for the errors of a map repeat
    /// from one scan to the next.
    #[cfg_attr(feature = "clap", arg(long, value_name = "METRES", default_value_t = 0.4, value_parser = parse_length))]
    pub key_m: f64,
    /// Or turned so far, degrees, 0..=180.
    #[cfg_attr(feature = "clap", arg(long, value_name = "DEGREES", default_value_t = 20.0, value_parser = parse_degrees))]
    pub key_deg: f64,
    /// The most that one key scan says for or against a place, natural logarithm of
    /// odds, 0..=100: what no model explains happens this often.
    #[cfg_attr(feature = "clap", arg(long, value_name = "LOG", default_value_t = 1.5, value_parser = parse_log))]
    pub scan_cap: f64,
    /// Probability at which a place is the only one, 0..=1.
    #[cfg_attr(feature = "clap", arg(long, value_name = "PROBABILITY", default_value_t = 0.94, value_parser = parse_share))]
    pub sure: f64,
    /// By this much the score of a scan may fall below the mean of those before it
    /// before the pose is doubted, 0..=1.
    #[cfg_attr(feature = "clap", arg(long, value_name = "SCORE", default_value_t = 0.25, value_parser = parse_share))]
    pub doubt_fall: f64,
    /// When the score falls by this much below the mean, the fit is tried again from
    /// headings around the prediction, 0..=1: odometry errs by tens of degrees at times.
    #[cfg_attr(feature = "clap", arg(long, value_name = "SCORE", default_value_t = 0.08, value_parser = parse_share))]
    pub restart_fall: f64,
}

#[cfg(feature = "clap")]
fn parse_factor(text: &str) -> Result<f64, String> {
    parse(text, 0.1..=10.0, "as a factor")
}

#[cfg(feature = "clap")]
fn parse_log(text: &str) -> Result<f64, String> {
    parse(text, 0.0..=100.0, "as a logarithm of odds")
}

impl Default for TrackingConfig {
    fn default() -> Self {
        TrackingConfig {
            start: Start::Confirm,
            odometry_error: 1.0,
            key_m: 0.4,
            key_deg: 20.0,
            scan_cap: 1.5,
            sure: 0.94,
            doubt_fall: 0.25,
            restart_fall: 0.08,
        }
    }
}
