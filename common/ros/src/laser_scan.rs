//! `sensor_msgs/msg/LaserScan`.

use messages::ScanHeader;

use super::{Header, Time};

declare! {
    /// One revolution of a laser.
    message LaserScan = "sensor_msgs/msg/LaserScan" [Header] {
        /// Time of the first beam, and the laser's frame.
        header: Header,
        /// Bearing of the first beam, in radians counter-clockwise from ahead.
        angle_min: f32,
        /// Bearing of the last beam, in radians.
        angle_max: f32,
        /// Angle between beams, in radians.
        angle_increment: f32,
        /// Time between beams, in seconds.
        time_increment: f32,
        /// Time between scans, in seconds.
        scan_time: f32,
        /// Smallest valid range, in metres.
        range_min: f32,
        /// Largest valid range, in metres.
        range_max: f32,
        /// Ranges in metres; infinity if nothing returned.
        ranges: Vec<f32>,
        /// Intensities in the device's own unit; empty if it has none.
        intensities: Vec<f32>,
    }
}

impl LaserScan {
    /// Converts a scan of the graph; `stamp` is the time of the header.
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
