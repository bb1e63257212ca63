//! `sensor_msgs/msg/LaserScan`.

use serde::{Deserialize, Serialize};

use super::definition::definition;
use super::{Header, RosMessage};

/// One turn of a laser.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct LaserScan {
    /// When the first beam was measured, and the laser's frame.
    pub header: Header,
    /// Bearing of the first beam, radians counter-clockwise from ahead.
    pub angle_min: f32,
    /// Bearing of the last beam, radians.
    pub angle_max: f32,
    /// From one beam to the next, radians.
    pub angle_increment: f32,
    /// From one beam to the next, seconds.
    pub time_increment: f32,
    /// From one scan to the next, seconds.
    pub scan_time: f32,
    /// Readings below are not returns, metres.
    pub range_min: f32,
    /// Readings above are not returns, metres.
    pub range_max: f32,
    /// Metres; infinity where nothing came back.
    pub ranges: Vec<f32>,
    /// In the device's own unit; empty where it gives none.
    pub intensities: Vec<f32>,
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
