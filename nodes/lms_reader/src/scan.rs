//! From a scan telegram to the message of topic `scan`.
//!
//! Pure: the caller says when the telegram came. It decides nothing about what
//! a range is good for; it only distinguishes readings from codes.

use messages::{FrameName, Name, Pose2, ScanHeader, Stamp};
use sick::cola::{AngleConvention, Channel, Field, LmdScanData, sweep_us};

use crate::clock::DeviceClock;
use crate::{LmsError, Stamps};

/// Raw distances below this are codes, not distances: 0 nothing came back, 1
/// dazzled, 2 implausible, the others reserved (SICK's operating instructions,
/// "LMDscandata – reserved values").
const FIRST_DISTANCE: u16 = 16;

/// The longest time from scan to transmission that is believed, µs. A mirror
/// turns at 5 Hz or faster.
const LONGEST_DELAY_US: u32 = 1_000_000;

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
mod tests {
    use super::*;
    use sick::cola::{DeviceTime, Encoding};

    const RECEIVED: Received = Received {
        realtime_ns: 1_700_000_000_000_000_000,
        monotonic_ns: 77,
    };

    fn settings() -> ScanSettings {
        ScanSettings {
            range_min_m: 0.05,
            range_max_m: Some(25.0),
            base_from_laser: None,
            upside_down: false,
            laser: Name::new(""),
            frame: FrameName::new("laser"),
            stamps: Stamps::Host,
        }
    }

    /// A telegram with the given times, angles in 1/10000° and raw distances.
    struct World {
        times_us: [u32; 2],
        layer: i16,
        name: [u8; 5],
        scale: f32,
        offset: f32,
        start: i32,
        step: u16,
        raw: Vec<u16>,
        convention: AngleConvention,
    }

    impl Default for World {
        fn default() -> Self {
            World {
                times_us: [5_000, 11_000],
                layer: 0,
                name: *b"DIST1",
                scale: 1.0,
                offset: 0.0,
                start: -450_000,
                step: 3333,
                raw: vec![1000; 811],
                convention: AngleConvention::USUAL,
            }
        }
    }

    impl World {
        fn telegram(&self) -> Vec<u8> {
            let mut bytes = b"sSN LMDscandata \0\x01\0\x01\0\0\0\0\0\0\0\0\0\0".to_vec();
            bytes.extend(self.times_us.map(u32::to_be_bytes).concat());
            bytes.extend([0; 4]);
            bytes.extend(self.layer.to_be_bytes());
            bytes.extend([0, 0, 5, 220, 0, 0, 0, 162, 0, 0, 0, 1]);
            bytes.extend(self.name);
            bytes.extend([self.scale, self.offset].map(f32::to_be_bytes).concat());
            bytes.extend(self.start.to_be_bytes());
            bytes.extend(self.step.to_be_bytes());
            bytes.extend((self.raw.len() as u16).to_be_bytes());
            bytes.extend(self.raw.iter().flat_map(|raw| raw.to_be_bytes()));
            bytes.extend([0; 12]);
            bytes
        }

        fn scan(&self) -> Result<(ScanHeader, Vec<f32>), LmsError> {
            let bytes = self.telegram();
            let data = LmdScanData::read(Encoding::Binary, &bytes)?;
            let distances = distances(&data)?;
            let mut clock = DeviceClock::default();
            let measured_ns = measured_ns(&data, &settings(), RECEIVED, &mut clock)?;
            check(&data, &distances)?;
            let angles = (self.convention, 80.0);
            let header = header(
                &data,
                &distances,
                angles,
                &settings(),
                measured_ns,
                RECEIVED,
            );
            let mut ranges = vec![0.0; distances.len()];
            fill_ranges(&distances, self.convention.clockwise, &mut ranges);
            Ok((header, ranges))
        }

        fn refusal(&self) -> String {
            self.scan().unwrap_err().to_string()
        }
    }

    #[test]
    fn ninety_degrees_of_the_device_is_ahead() {
        let (header, ranges) = World::default().scan().unwrap();
        assert_eq!(header.angle_min, f64::from((-135f64).to_radians() as f32));
        // Single precision has 24 bits.
        assert!((header.angle_increment.to_degrees() - 0.3333).abs() < 0.3333 * 6e-8);
        assert_eq!(ranges.len(), 811);
        // Beam 405 of 811 at steps of 0.3333° is 0.0135° short of ahead.
        let ahead = header.angle_min + 405.0 * header.angle_increment;
        assert!(
            (ahead.to_degrees() + 0.0135).abs() < 135.0 * 6e-8,
            "{ahead}"
        );
    }

    #[test]
    fn the_stamp_is_back_at_the_scan_also_across_the_wrap_of_the_clock() {
        for times_us in [[5_000, 11_000], [u32::MAX - 999, 5_000]] {
            let (header, _) = World {
                times_us,
                ..World::default()
            }
            .scan()
            .unwrap();
            assert_eq!(header.stamp.measured_ns, RECEIVED.realtime_ns - 6_000_000);
            assert_eq!(header.stamp.entered_ns, 77);
        }
    }

    #[test]
    fn the_devices_date_and_time_are_taken_as_they_are() {
        let bytes = World::default().telegram();
        let mut data = LmdScanData::read(Encoding::Binary, &bytes).unwrap();
        let settings = ScanSettings {
            stamps: Stamps::Device,
            ..settings()
        };
        let measured =
            |data: &_| measured_ns(data, &settings, RECEIVED, &mut DeviceClock::default());
        let error = measured(&data).unwrap_err().to_string();
        assert!(
            error.contains("--stamps device): it has no time"),
            "{error}"
        );
        data.time = DeviceTime::from_unix_us(1_137_772_793_094_057);
        assert_eq!(measured(&data).unwrap(), 1_137_772_793_094_057_000);
        data.time = data.time.map(|time| DeviceTime { month: 0, ..time });
        let error = measured(&data).unwrap_err().to_string();
        assert!(error.contains("month: 0"), "{error}");
    }

    #[test]
    fn times_come_from_the_turn_of_the_mirror() {
        let (header, _) = World::default().scan().unwrap();
        // 15 Hz; 1080 steps of a third of a degree make a turn, the rounding of
        // the step to 1/10000° is one part in 10⁴.
        assert!((header.scan_time_s - 1.0 / 15.0).abs() < 1e-12);
        assert!((header.time_increment_s * 1080.0 * 15.0 - 1.0).abs() < 1.1e-4);
    }

    #[test]
    fn codes_are_no_returns_and_the_scale_applies() {
        let raw = vec![0, 1, 2, 15, 16, 2000, 65535];
        let (_, ranges) = World {
            raw,
            scale: 2.0,
            offset: 500.0,
            ..World::default()
        }
        .scan()
        .unwrap();
        let inf = f32::INFINITY;
        assert_eq!(ranges, [inf, inf, inf, inf, 0.532, 4.5, 131.57]);
    }

    #[test]
    fn a_clockwise_device_is_read_from_its_last_beam() {
        // Half a turn at 15 Hz; 180° of the device is ahead.
        let (header, ranges) = World {
            start: 900_000,
            step: 10_000,
            raw: (1000..1181).collect(),
            convention: AngleConvention {
                ahead_deg: 180.0,
                clockwise: true,
            },
            ..World::default()
        }
        .scan()
        .unwrap();
        assert_eq!(header.angle_min, recordable((-90f64).to_radians()));
        assert_eq!(header.angle_increment, recordable(1f64.to_radians()));
        // Its first reading, at 90°, is to the left.
        assert_eq!((ranges.len(), ranges[0], ranges[180]), (181, 1.18, 1.0));
        // The first beam of the message is the last that was measured.
        let first_ns = RECEIVED.realtime_ns - 6_000_000;
        assert_eq!(header.stamp.measured_ns, first_ns + 33_333_000);
        let back_ns = (header.time_increment_s * 180.0 * 1e9).round() as i64;
        // Whole microseconds.
        assert!((header.stamp.measured_ns + back_ns - first_ns).abs() < 1000);
    }

    #[test]
    fn zero_ahead_is_the_middle_of_a_tim240() {
        let (header, _) = World {
            start: -1_200_000,
            step: 10_000,
            raw: vec![1000; 241],
            convention: AngleConvention {
                ahead_deg: 0.0,
                clockwise: false,
            },
            ..World::default()
        }
        .scan()
        .unwrap();
        assert_eq!(header.angle_min, recordable((-120f64).to_radians()));
        assert!(header.time_increment_s > 0.0);
    }

    #[test]
    fn the_settings_are_passed_on() {
        let bytes = World::default().telegram();
        let data = LmdScanData::read(Encoding::Binary, &bytes).unwrap();
        let channel = distances(&data).unwrap();
        let mount = Pose2 {
            x: 0.78,
            y: 0.0,
            yaw: 0.1,
        };
        let settings = ScanSettings {
            base_from_laser: Some(mount),
            ..settings()
        };
        let angles = (AngleConvention::USUAL, 250.0);
        let with = header(&data, &channel, angles, &settings, 5, RECEIVED);
        assert_eq!(with.stamp.measured_ns, 5);
        assert_eq!((with.base_from_laser, with.mount_known), (mount, 1));
        assert_eq!((with.range_min_m, with.range_max_m), (0.05, 25.0));
        assert_eq!(with.frame.as_str(), "laser");
        assert_eq!(World::default().scan().unwrap().0.mount_known, 0);
        // Where nobody says it, it is what the device is known to measure.
        let settings = ScanSettings {
            range_max_m: None,
            ..settings
        };
        let far = header(&data, &channel, angles, &settings, 5, RECEIVED);
        assert_eq!(far.range_max_m, 250.0);
    }

    #[test]
    fn what_makes_no_scan_is_refused() {
        let world = World::default;
        assert!(
            World {
                raw: vec![],
                ..world()
            }
            .refusal()
            .contains("`count` of channel DIST1 is 0, allowed is at least 1")
        );
        assert!(
            World { step: 0, ..world() }
                .refusal()
                .contains("`angular step`")
        );
        assert!(
            World {
                step: 6000,
                ..world()
            }
            .refusal()
            .contains("`sweep` of channel DIST1 is 486")
        );
        assert!(
            World {
                scale: -1.0,
                ..world()
            }
            .refusal()
            .contains("`scale factor`")
        );
        assert!(
            World {
                scale: f32::NAN,
                ..world()
            }
            .refusal()
            .contains("NaN")
        );
        assert!(
            World {
                layer: 250,
                ..world()
            }
            .refusal()
            .contains("`layer angle`")
        );
        assert!(
            World {
                times_us: [9, 8],
                ..world()
            }
            .refusal()
            .contains("0 to 1 s")
        );
        let refusal = World {
            name: *b"RSSI1",
            ..world()
        }
        .refusal();
        assert!(refusal.contains("[RSSI1], a scan needs DIST1"), "{refusal}");
    }
}
