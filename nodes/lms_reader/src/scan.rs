//! From a scan telegram to the message of topic `scan`.
//!
//! Pure: the caller says when the telegram came. It decides nothing about what
//! a range is good for; it only distinguishes readings from codes.

use clap::ValueEnum;
use messages::{FrameName, Name, Pose2, ScanHeader, Stamp};
use sick::cola::{AngleConvention, Channel, Field, LmdScanData, sweep_us};

use crate::LmsError;
use crate::clock::DeviceClock;

/// Raw distances below this are codes, not distances: 0 nothing came back, 1
/// dazzled, 2 implausible, the others reserved (SICK's operating instructions,
/// "LMDscandata – reserved values").
const FIRST_DISTANCE: u16 = 16;

/// The longest time from scan to transmission that is believed, µs. A mirror
/// turns at 5 Hz or faster.
const LONGEST_DELAY_US: u32 = 1_000_000;

/// Whose time a scan gets.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Stamps {
    /// The host's, when the first beam was shot: the device's counter of
    /// microseconds is followed.
    Host,
    /// The device's date and time, which must be set, by NTP say; telegrams are
    /// made to carry it.
    Device,
}

/// What the telegram does not say.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ScanSettings {
    /// Readings below are no returns, metres.
    pub range_min_m: f32,
    /// Readings from here on are no returns, metres; `None` is what the device is
    /// known to measure.
    pub range_max_m: Option<f32>,
    /// Where the laser sits on the robot, if that is known.
    pub base_from_laser: Option<Pose2>,
    /// Whether it hangs upside down.
    pub upside_down: bool,
    /// Which of several lasers it is; empty where the graph has one.
    pub laser: Name,
    /// The laser's frame.
    pub frame: FrameName,
    /// Whose time the scan gets.
    pub stamps: Stamps,
}

/// When the last byte of a telegram was here.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Received {
    /// Nanoseconds since 1970.
    pub realtime_ns: i64,
    /// `CLOCK_MONOTONIC` in nanoseconds.
    pub monotonic_ns: i64,
}

/// The channel that makes the scan: the first echo.
///
/// # Errors
/// [`LmsError::NoDistances`], which names the channels that there are.
pub fn distances<'a>(data: &LmdScanData<'a>) -> Result<Channel<'a>, LmsError> {
    data.channels_16_bit.named(b"DIST1").ok_or_else(|| {
        let names = data.channels_16_bit.clone();
        let names: Vec<String> = names.map(|c| c.name.escape_ascii().to_string()).collect();
        LmsError::NoDistances {
            found: names.join(", "),
        }
    })
}

/// When the first beam was shot, nanoseconds since 1970.
///
/// By the host's clock it is when `clock` says that the telegram was transmitted,
/// less what the device counted from "time since start-up" to "time of
/// transmission". SICK documents the former as the moment before the measurement
/// starts. A TiM781 is seen to put 6 to 7 ms between the two although its scan
/// takes 50 ms, so there the stamp is late by most of a scan.
///
/// # Errors
/// [`LmsError::Scan`] where the device's times make no sense, [`LmsError::NoTime`]
/// where its date and time are wanted and it does not say them.
pub(crate) fn measured_ns(
    data: &LmdScanData<'_>,
    settings: &ScanSettings,
    received: Received,
    clock: &mut DeviceClock,
) -> Result<i64, LmsError> {
    if settings.stamps == Stamps::Device {
        let unix_us = data.time.and_then(|time| time.unix_us());
        return unix_us
            .map(|us| us.saturating_mul(1000))
            .ok_or_else(|| LmsError::NoTime {
                found: data
                    .time
                    .map_or("it has no time".into(), |time| format!("{time:?}")),
            });
    }
    let delay_ns = delay_ns(data)?;
    let sent_ns = clock.host_ns(data.time_of_transmission_us, received.monotonic_ns);
    let on_the_way_ns = received.monotonic_ns - sent_ns;
    Ok(received.realtime_ns - on_the_way_ns - delay_ns)
}

/// The header of the scan whose first shot was at `measured_ns`, with counter 0.
/// `angles` are those of the device, which has passed [`check`].
///
/// Beams go counter-clockwise whichever way the device turns. Where it turns
/// clockwise, the first beam is the one that was measured last: the stamp is its
/// time, and time runs backwards from beam to beam.
#[must_use]
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
    ScanHeader {
        stamp: Stamp {
            measured_ns: measured_ns.saturating_add(sweep_us * 1000),
            entered_ns: received.monotonic_ns,
            counter: 0,
        },
        angle_min: recordable(angle_deg.to_radians()),
        angle_increment: recordable(step_deg.to_radians()),
        // From the turn of the mirror: firmware disagrees about the unit of the
        // measurement frequency, and a step takes its share of a turn anyway.
        time_increment_s: sign * scan_time_s * step_deg / 360.0,
        scan_time_s,
        range_min_m: settings.range_min_m,
        range_max_m: settings.range_max_m.unwrap_or(reach_m),
        base_from_laser: settings.base_from_laser.unwrap_or(Pose2 {
            x: 0.0,
            y: 0.0,
            yaw: 0.0,
        }),
        mount_known: u64::from(settings.base_from_laser.is_some()),
        upside_down: settings.upside_down.into(),
        laser: settings.laser,
        frame: settings.frame,
    }
}

/// An angle as recordings hold it (`sensor_msgs/LaserScan` has single precision), so
/// that a recording of the graph gives the same answers to the last bit.
pub(crate) fn recordable(radians: f64) -> f64 {
    f64::from(radians as f32)
}

/// Writes the distances in metres, infinity where nothing came back, those of a
/// device that turns `clockwise` from the last to the first; `ranges` has as many
/// places as there are distances.
pub fn fill_ranges(distances: &Channel<'_>, clockwise: bool, ranges: &mut [f32]) {
    let scale = f64::from(distances.scale_factor);
    let offset = f64::from(distances.scale_offset);
    for (range, raw) in ranges.iter_mut().zip(distances.values) {
        *range = if raw < FIRST_DISTANCE {
            f32::INFINITY
        } else {
            ((f64::from(raw) * scale + offset) * 1e-3) as f32
        };
    }
    if clockwise {
        ranges.reverse();
    }
}

/// Whether the telegram makes a scan.
///
/// # Errors
/// [`LmsError::Scan`] with the field that does not fit.
pub fn check(data: &LmdScanData<'_>, distances: &Channel<'_>) -> Result<(), LmsError> {
    let step_deg = f64::from(distances.step_raw_1e4_deg) * 1e-4;
    let sweep_deg = step_deg * distances.len().saturating_sub(1) as f64;
    let scale = f64::from(distances.scale_factor);
    let layer = f64::from(data.layer_angle_raw);
    let rules = [
        ("layer angle", layer, layer == 0.0, "0, the level layer"),
        ("count", 0.0, !distances.is_empty(), "at least 1"),
        ("angular step", step_deg, step_deg > 0.0, "above 0°"),
        ("sweep", sweep_deg, sweep_deg <= 360.0, "at most 360°"),
        ("scale factor", scale, scale > 0.0, "above 0"),
    ];
    match rules.into_iter().find(|(_, _, holds, _)| !holds) {
        None => Ok(()),
        Some((field, found, _, allowed)) => Err(LmsError::Scan {
            field,
            found,
            allowed,
        }),
    }
}

fn delay_ns(data: &LmdScanData<'_>) -> Result<i64, LmsError> {
    // The device's clock wraps, the difference does not mind.
    let delay_us = data
        .time_of_transmission_us
        .wrapping_sub(data.time_since_start_up_us);
    if delay_us <= LONGEST_DELAY_US {
        return Ok(i64::from(delay_us) * 1000);
    }
    Err(LmsError::Scan {
        field: "time from scan to transmission",
        found: f64::from(delay_us) * 1e-6,
        allowed: "0 to 1 s",
    })
}

#[cfg(test)]
mod tests;
