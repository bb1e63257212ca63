//! Converts a scan telegram to the message of topic `scan`.
//!
//! Pure: the caller passes the time of reception. It does not interpret ranges; it only
//! distinguishes readings from codes.

use clap::ValueEnum;
use geometry::Pose;
use messages::{FrameName, Name, Pose2, ScanHeader, Stamp};
use sick::cola::{AngleConvention, Channel, Field, LmdScanData, sweep_us};

use crate::LmsError;
use crate::clock::DeviceClock;

/// Longest accepted time from scan to transmission, µs. A mirror turns at 5 Hz or faster.
const LONGEST_DELAY_US: u32 = 1_000_000;

/// Clock that stamps the scans.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Stamps {
    /// Host time at which the first beam was measured, derived from the device's microsecond
    /// counter.
    Host,
    /// Date and time of the device, which must be set, for example by NTP; the node configures the
    /// telegrams to contain it.
    Device,
}

/// Settings of a scan that are not in the telegram.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ScanSettings {
    /// Shortest valid range, metres; shorter readings are no returns.
    pub range_min_m: f32,
    /// Longest valid range, metres; readings from here on are no returns. `None`: the longest range
    /// of the device.
    pub range_max_m: Option<f32>,
    /// Pose of the laser on the robot, if known.
    pub base_from_laser: Option<Pose2>,
    /// True if the laser hangs upside down.
    pub upside_down: bool,
    /// Name of the laser among several; empty if the graph has one.
    pub laser: Name,
    pub frame: FrameName,
    /// Clock that stamps the scan.
    pub stamps: Stamps,
}

/// Angles, radians, and times of a scan's beams.
pub(crate) struct Beams {
    pub(crate) angle_min: f64,
    pub(crate) angle_increment: f64,
    pub(crate) time_increment_s: f64,
    pub(crate) scan_time_s: f64,
}

impl ScanSettings {
    /// Returns the header of a scan, with counter 0; `reach_m` is the longest range of the device.
    pub(crate) fn header(
        &self,
        beams: &Beams,
        measured_ns: i64,
        entered_ns: i64,
        reach_m: f32,
    ) -> ScanHeader {
        ScanHeader {
            stamp: Stamp {
                measured_ns,
                entered_ns,
                counter: 0,
            },
            angle_min: recordable(beams.angle_min),
            angle_increment: recordable(beams.angle_increment),
            time_increment_s: beams.time_increment_s,
            scan_time_s: beams.scan_time_s,
            range_min_m: self.range_min_m,
            range_max_m: self.range_max_m.unwrap_or(reach_m),
            base_from_laser: self.base_from_laser.unwrap_or(Pose::IDENTITY.into()),
            mount_known: u64::from(self.base_from_laser.is_some()),
            upside_down: self.upside_down.into(),
            laser: self.laser,
            frame: self.frame,
        }
    }
}

/// Time at which the last byte of a telegram was received.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Received {
    /// Nanoseconds since 1970.
    pub realtime_ns: i64,
    /// `CLOCK_MONOTONIC` in nanoseconds.
    pub monotonic_ns: i64,
}

/// Returns the channel of the scan: distances of the first echo.
pub fn distances<'a>(data: &LmdScanData<'a>) -> Result<Channel<'a>, LmsError> {
    data.channels_16_bit.named(b"DIST1").ok_or_else(|| {
        let names = data.channels_16_bit.clone();
        let names: Vec<String> = names.map(|c| c.name.escape_ascii().to_string()).collect();
        LmsError::Other(format!(
            "the telegram has the 16-bit channels [{}], a scan needs DIST1",
            names.join(", ")
        ))
    })
}

/// Returns the time at which the first beam was measured, nanoseconds since 1970.
///
/// With host stamps it is the time of transmission according to `clock`, minus the device's
/// difference between "time of transmission" and "time since start-up". SICK documents the latter
/// as the moment before the measurement starts. On a TiM781 the two are only 6 to 7 ms apart
/// although its scan takes 50 ms, so its stamps are late by most of a scan.
pub(crate) fn measured_ns(
    data: &LmdScanData<'_>,
    settings: &ScanSettings,
    received: Received,
    clock: &mut DeviceClock,
) -> Result<i64, LmsError> {
    if settings.stamps == Stamps::Device {
        let unix_us = data.time.and_then(|time| time.unix_us());
        return unix_us.map(|us| us.saturating_mul(1000)).ok_or_else(|| {
            let found = data.time.map(|time| format!("{time:?}"));
            LmsError::Other(format!(
                "the telegram does not say the date and time of the scan (--stamps device): {}",
                found.as_deref().unwrap_or("it has no time")
            ))
        });
    }
    let delay_ns = delay_ns(data)?;
    let sent_ns = clock.host_ns(data.time_of_transmission_us, received.monotonic_ns);
    let on_the_way_ns = received.monotonic_ns - sent_ns;
    Ok(received.realtime_ns - on_the_way_ns - delay_ns)
}

/// Returns the header of a scan whose first beam was measured at `measured_ns`, with counter 0.
/// `angles` are convention and longest range of the device; `data` has passed [`check`].
///
/// Beams are ordered counter-clockwise whichever way the device turns. If it turns clockwise, the
/// first beam is the one measured last: the stamp is its time, and the time increment is negative.
pub fn header(
    data: &LmdScanData<'_>,
    distances: &Channel<'_>,
    angles: (AngleConvention, f32),
    settings: &ScanSettings,
    measured_ns: i64,
    received: Received,
) -> ScanHeader {
    let (convention, reach_m) = angles;
    let step_deg = f64::from(distances.step_raw_1e4_deg) * 1e-4;
    let angle_deg = convention.rightmost_bearing_deg(Field::of(distances));
    let scan_time_s = match data.scan_frequency_raw_1e2_hz {
        0 => 0.0,
        frequency => 100.0 / f64::from(frequency),
    };
    let (sign, sweep_us) = match convention.clockwise {
        true => (-1.0, sweep_us(distances, data.scan_frequency_raw_1e2_hz)),
        false => (1.0, 0),
    };
    let beams = Beams {
        angle_min: angle_deg.to_radians(),
        angle_increment: step_deg.to_radians(),
        // Derived from the mirror frequency: firmware versions disagree about the unit of the
        // measurement frequency.
        time_increment_s: sign * scan_time_s * step_deg / 360.0,
        scan_time_s,
    };
    let measured_ns = measured_ns.saturating_add(sweep_us * 1000);
    settings.header(&beams, measured_ns, received.monotonic_ns, reach_m)
}

/// Rounds an angle to single precision, as in recordings (`sensor_msgs/LaserScan`), so that
/// replaying a recording gives bit-identical results.
pub(crate) fn recordable(radians: f64) -> f64 {
    f64::from(radians as f32)
}

/// Writes the distances in metres, infinity for no return, in reverse order for a `clockwise`
/// device; `ranges` has one element per distance.
pub fn fill_ranges(distances: &Channel<'_>, clockwise: bool, ranges: &mut [f32]) {
    for (range, metres) in ranges.iter_mut().zip(distances.distances_m()) {
        *range = metres.map_or(f32::INFINITY, |metres| metres as f32);
    }
    if clockwise {
        ranges.reverse();
    }
}

/// Checks that the telegram can be converted to a scan.
pub fn check(data: &LmdScanData<'_>, distances: &Channel<'_>) -> Result<(), LmsError> {
    let count = distances.values.len();
    let step_deg = f64::from(distances.step_raw_1e4_deg) * 1e-4;
    let sweep_deg = step_deg * count.saturating_sub(1) as f64;
    let scale = f64::from(distances.scale_factor);
    let layer = f64::from(data.layer_angle_raw);
    let rules = [
        ("layer angle", layer, layer == 0.0, "0, the level layer"),
        ("count", 0.0, count > 0, "at least 1"),
        ("angular step", step_deg, step_deg > 0.0, "above 0°"),
        ("sweep", sweep_deg, sweep_deg <= 360.0, "at most 360°"),
        ("scale factor", scale, scale > 0.0, "above 0"),
    ];
    match rules.into_iter().find(|(_, _, holds, _)| !holds) {
        None => Ok(()),
        Some((field, found, _, allowed)) => Err(not_allowed(field, found, allowed)),
    }
}

fn not_allowed(field: &str, found: f64, allowed: &str) -> LmsError {
    LmsError::Other(format!(
        "`{field}` of channel DIST1 is {found}, allowed is {allowed}"
    ))
}

fn delay_ns(data: &LmdScanData<'_>) -> Result<i64, LmsError> {
    // The difference is right even if the device's clock wraps in between.
    let delay_us = data
        .time_of_transmission_us
        .wrapping_sub(data.time_since_start_up_us);
    if delay_us <= LONGEST_DELAY_US {
        return Ok(i64::from(delay_us) * 1000);
    }
    let found = f64::from(delay_us) * 1e-6;
    Err(not_allowed(
        "time from scan to transmission",
        found,
        "0 to 1 s",
    ))
}

#[cfg(test)]
pub(crate) mod tests;
