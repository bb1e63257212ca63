//! Settings for joining scans.

/// Lasers that are joined, and the measurement of motion.
#[derive(Debug, Clone, PartialEq, Default)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
pub struct JoinConfig {
    /// Lasers whose scans are joined, the main one first: a new scan of it triggers an
    /// answer. By default the graph has one laser.
    #[cfg_attr(feature = "clap", arg(long, value_name = "LASER,LASER", value_delimiter = ',', value_parser = parse_laser))]
    pub scans: Vec<String>,
    /// Measurement of the motion.
    #[cfg_attr(feature = "clap", command(flatten))]
    pub motion: MotionConfig,
}

/// Measurement of the motion within a scan and between scans.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
pub struct MotionConfig {
    /// Added to the stamps of odometry, seconds, -1..=1: positive if odometry leads the
    /// laser.
    #[cfg_attr(feature = "clap", arg(long, value_name = "SECONDS", default_value_t = 0.0, allow_negative_numbers = true, value_parser = crate::config::within(-1.0..=1.0, "seconds")))]
    pub odometry_delay_s: f64,
    /// Beam to which the stamp of a scan belongs.
    #[cfg_attr(feature = "clap", arg(long, value_enum, default_value_t = ScanStamp::First))]
    pub scan_stamp: ScanStamp,
    /// True if the motion within a scan is compensated (deskewed), if odometry covers it.
    #[cfg_attr(feature = "clap", arg(long, value_name = "BOOL", default_value_t = true, action = clap::ArgAction::Set))]
    pub deskew: bool,
}

/// Beam to which the stamp of a scan belongs.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(feature = "clap", derive(clap::ValueEnum))]
pub enum ScanStamp {
    /// The first beam, as `sensor_msgs/LaserScan` defines it.
    #[default]
    First,
    /// The middle beam.
    Middle,
    /// The last beam.
    Last,
}

impl MotionConfig {
    /// Offset added to odometry stamps, in nanoseconds.
    pub(crate) fn delay_ns(&self) -> i64 {
        (self.odometry_delay_s * 1e9).round() as i64
    }
}

impl Default for MotionConfig {
    fn default() -> Self {
        MotionConfig {
            odometry_delay_s: 0.0,
            scan_stamp: ScanStamp::First,
            deskew: true,
        }
    }
}

#[cfg(feature = "clap")]
fn parse_laser(text: &str) -> Result<String, String> {
    match text.len() {
        1..=messages::Name::CAPACITY => Ok(text.into()),
        length => Err(format!(
            "the name of a laser has {length} bytes: allowed are 1 to {}",
            messages::Name::CAPACITY
        )),
    }
}
