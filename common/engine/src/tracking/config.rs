//! The settings of the tracker.

#[cfg(feature = "clap")]
use crate::config::{parse, parse_degrees, parse_length, parse_share};

/// What the tracker expects of odometry and of scans. docs/tracking.md explains what
/// each setting is for and what becomes of the figures without it.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
pub struct TrackingConfig {
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
    /// The most that one key scan says against a place, natural logarithm of odds,
    /// 0..=100.
    #[cfg_attr(feature = "clap", arg(long, value_name = "LOG", default_value_t = 4.0, value_parser = parse_log))]
    pub scan_cap: f64,
    /// The lead over the next place at which one is the only one, natural logarithm of
    /// odds, 0..=100. Three key scans at least have to agree on it.
    #[cfg_attr(feature = "clap", arg(long, value_name = "LOG", default_value_t = 12.0, value_parser = parse_log))]
    pub sure_lead: f64,
    /// The mean score of the scans at a place that needs no more than this lead; what
    /// it lacks must be made up for by the lead, see `--poor-fit-lead`.
    #[cfg_attr(feature = "clap", arg(long, value_name = "SCORE", default_value_t = 0.85, value_parser = parse_share))]
    pub sure_mean: f64,
    /// The lead that a lack of 1 in the mean score must be made up for by, 0..=100.
    #[cfg_attr(feature = "clap", arg(long, value_name = "LOG", default_value_t = 20.0, value_parser = parse_log))]
    pub poor_fit_lead: f64,
    /// What a place is behind that is found later than the others, 0..=100.
    #[cfg_attr(feature = "clap", arg(long, value_name = "LOG", default_value_t = 10.0, value_parser = parse_log))]
    pub newborn_lag: f64,
    /// The same while the pose is unique and fits.
    #[cfg_attr(feature = "clap", arg(long, value_name = "LOG", default_value_t = 20.0, value_parser = parse_log))]
    pub newborn_lag_unique: f64,
    /// The same near the pose that is tracked.
    #[cfg_attr(feature = "clap", arg(long, value_name = "LOG", default_value_t = 5.0, value_parser = parse_log))]
    pub newborn_lag_near: f64,
    /// By this much the score of a scan may fall below the mean of those before it
    /// before the pose is doubted, 0..=1.
    #[cfg_attr(feature = "clap", arg(long, value_name = "SCORE", default_value_t = 0.25, value_parser = parse_share))]
    pub doubt_fall: f64,
    /// A scan with a lower score makes the pose doubtful in any case, 0..=1.
    #[cfg_attr(feature = "clap", arg(long, value_name = "SCORE", default_value_t = 0.5, value_parser = parse_share))]
    pub doubt_score: f64,
    /// A mean score below this is never unique, 0..=1.
    #[cfg_attr(feature = "clap", arg(long, value_name = "SCORE", default_value_t = 0.6, value_parser = parse_share))]
    pub least_mean: f64,
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
            odometry_error: 1.0,
            key_m: 0.4,
            key_deg: 20.0,
            scan_cap: 4.0,
            sure_lead: 12.0,
            sure_mean: 0.85,
            poor_fit_lead: 20.0,
            newborn_lag: 10.0,
            newborn_lag_unique: 20.0,
            newborn_lag_near: 5.0,
            doubt_fall: 0.25,
            doubt_score: 0.5,
            least_mean: 0.6,
            restart_fall: 0.08,
        }
    }
}
