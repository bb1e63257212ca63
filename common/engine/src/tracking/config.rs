//! Settings of the tracker.

#[cfg(feature = "clap")]
use crate::config::{parse_degrees, parse_length, parse_share, within};

/// Time at which a tracker without knowledge believes a place.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "clap", derive(clap::ValueEnum))]
pub enum Start {
    /// When several key scans agree: the robot has to drive or turn.
    Confirm,
    /// When the verdict on one scan is `Unique`: the robot may stand still.
    Believe,
}

/// Expected errors of odometry and scans. docs/tracking.md explains the purpose of each setting and
/// the accuracy without it.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
pub struct TrackingConfig {
    /// When a tracker that knows no pose yet believes a place.
    #[cfg_attr(
        feature = "clap",
        arg(long, value_name = "WHEN", default_value = "confirm")
    )]
    pub start: Start,
    /// Scale of the usual standard deviations of odometry, 0.1..=10.
    #[cfg_attr(feature = "clap", arg(long, value_name = "FACTOR", default_value_t = 1.0, value_parser = within(0.1..=10.0, "as a factor")))]
    pub odometry_error: f64,
    /// Distance between key scans, metres, 0..=2. Places are weighed against each other at key
    /// scans only, because the errors of a map repeat from one scan to the next.
    #[cfg_attr(feature = "clap", arg(long, value_name = "METRES", default_value_t = 0.4, value_parser = parse_length))]
    pub key_m: f64,
    /// Rotation between key scans, degrees, 0..=180; the first of distance and rotation counts.
    #[cfg_attr(feature = "clap", arg(long, value_name = "DEGREES", default_value_t = 20.0, value_parser = parse_degrees))]
    pub key_deg: f64,
    /// Maximum evidence of one key scan for or against a place, natural logarithm of odds, 0..=100:
    /// this often, a scan is explained by no model.
    #[cfg_attr(feature = "clap", arg(long, value_name = "LOG", default_value_t = 1.5, value_parser = within(0.0..=100.0, "as a logarithm of odds")))]
    pub scan_cap: f64,
    /// Probability from which a place is unique, 0..=1.
    #[cfg_attr(feature = "clap", arg(long, value_name = "PROBABILITY", default_value_t = 0.94, value_parser = parse_share))]
    pub sure: f64,
    /// Fall of the score of a scan below the mean of those before it at which the pose is doubted,
    /// 0..=1.
    #[cfg_attr(feature = "clap", arg(long, value_name = "SCORE", default_value_t = 0.25, value_parser = parse_share))]
    pub doubt_fall: f64,
    /// Fall of the score below the mean at which the fit is tried again from headings around the
    /// prediction, 0..=1, as odometry sometimes errs by tens of degrees.
    #[cfg_attr(feature = "clap", arg(long, value_name = "SCORE", default_value_t = 0.08, value_parser = parse_share))]
    pub restart_fall: f64,
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
