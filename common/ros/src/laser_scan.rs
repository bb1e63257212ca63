//! `sensor_msgs/msg/LaserScan`.

use messages::ScanHeader;
use serde::{Deserialize, Serialize};

use super::definition::definition;
use super::{Header, RosMessage, Time};

/// One revolution of a laser.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct LaserScan {
    /// Time of the first beam, and the laser's frame.
    pub header: Header,
    /// Bearing of the first beam, in radians counter-clockwise from ahead.
    pub angle_min: f32,
    /// Bearing of the last beam, in radians.
    pub angle_max: f32,
    /// Angle between beams, in radians.
    pub angle_increment: f32,
    /// Time between beams, in seconds.
    pub time_increment: f32,
    /// Time between scans, in seconds.
    pub scan_time: f32,
    /// Smallest valid range, in metres.
    pub range_min: f32,
    /// Largest valid range, in metres.
    pub range_max: f32,
    /// Ranges in metres; infinity if nothing returned.
    pub ranges: Vec<f32>,
    /// Intensities in the device's own unit; empty if it has none.
    pub intensities: Vec<f32>,
}

impl LaserScan {
    /// Converts a scan of the graph; `stamp` is the time of the header.
    #[must_use]
    pub fn of(stamp: Time, scan: &ScanHeader, ranges: &[f32]) -> Self {
        let steps = ranges.len().saturating_sub(1) as f64;
        LaserScan {
            header: Header::new(stamp, scan.frame.as_str()),
            // Recordings hold 32-bit floats, and the values of a replayed scan came from them.
            angle_min: scan.angle_min as f32,
            angle_max: (scan.angle_min + steps * scan.angle_increment) as f32,
            angle_increment: scan.angle_increment as f32,
            time_increment: scan.time_increment_s as f32,
            scan_time: scan.scan_time_s as f32,
            range_min: scan.range_min_m,
            range_max: scan.range_max_m,
            ranges: ranges.to_vec(),
            intensities: Vec::new(),
        }
    }
}

impl RosMessage for LaserScan {
    const SCHEMA: &'static str = "sensor_msgs/msg/LaserScan";
    const DEFINITION: &'static str = definition!(
        "\
std_msgs/Header header
float32 angle_min
float32 angle_max
float32 angle_increment
float32 time_increment
float32 scan_time
float32 range_min
float32 range_max
float32[] ranges
float32[] intensities
",
        Header,
    );
}
