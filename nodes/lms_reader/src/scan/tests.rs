use super::*;
use sick::cola::{Channels, DeviceTime};

pub(crate) const RECEIVED: Received = Received {
    realtime_ns: 1_700_000_000_000_000_000,
    monotonic_ns: 77,
};

pub(crate) fn settings() -> ScanSettings {
    ScanSettings {
        range_min_m: 0.05,
        range_max_m: None,
        base_from_laser: None,
        upside_down: false,
        laser: Name::new(""),
        frame: FrameName::new("laser"),
        stamps: Stamps::Host,
    }
}

/// Telegram with the given times, angles in 1/10000° and raw distances.
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
    /// Passes the telegram and the distances in it to `take`.
    fn with<R>(&self, take: impl FnOnce(&mut LmdScanData<'_>) -> R) -> R {
        let channels = [Channel {
            name: self.name,
            scale_factor: self.scale,
            scale_offset: self.offset,
            start_angle_raw_1e4_deg: self.start,
            step_raw_1e4_deg: self.step,
            values: self.raw[..].into(),
        }];
        take(&mut LmdScanData {
            time_since_start_up_us: self.times_us[0],
            time_of_transmission_us: self.times_us[1],
            layer_angle_raw: self.layer,
            scan_frequency_raw_1e2_hz: 1500,
            channels_16_bit: Channels::from(&channels[..]),
            ..LmdScanData::default()
        })
    }

    fn scan(&self) -> Result<(ScanHeader, Vec<f32>), LmsError> {
        let settings = settings();
        self.with(|data| {
            let distances = distances(data)?;
            let mut clock = DeviceClock::default();
            let measured_ns = measured_ns(data, &settings, RECEIVED, &mut clock)?;
            check(data, &distances)?;
            let angles = (self.convention, 250.0);
            let header = header(data, &distances, angles, &settings, measured_ns, RECEIVED);
            let mut ranges = vec![0.0; distances.values.len()];
            fill_ranges(&distances, self.convention.clockwise, &mut ranges);
            Ok((header, ranges))
        })
    }
}

#[test]
fn ninety_degrees_of_the_device_is_ahead() {
    let (header, ranges) = World::default().scan().unwrap();
    assert_eq!(header.angle_min, f64::from((-135f64).to_radians() as f32));
    // Single precision has 24 bits.
    assert!((header.angle_increment.to_degrees() - 0.3333).abs() < 0.3333 * 6e-8);
    assert_eq!(ranges.len(), 811);
    // The longest range is the device's if no option sets it.
    assert_eq!((header.range_min_m, header.range_max_m), (0.05, 250.0));
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
    let settings = ScanSettings {
        stamps: Stamps::Device,
        ..settings()
    };
    let measured = |time| {
        World::default().with(|data| {
            data.time = time;
            measured_ns(data, &settings, RECEIVED, &mut DeviceClock::default())
        })
    };
    let error = measured(None).unwrap_err().to_string();
    assert!(
        error.contains("--stamps device): it has no time"),
        "{error}"
    );
    let time = DeviceTime::from_unix_us(1_137_772_793_094_057);
    assert_eq!(measured(time).unwrap(), 1_137_772_793_094_057_000);
    let never_set = time.map(|time| DeviceTime { month: 0, ..time });
    let error = measured(never_set).unwrap_err().to_string();
    assert!(error.contains("month: 0"), "{error}");
}

#[test]
fn times_come_from_the_turn_of_the_mirror() {
    let (header, _) = World::default().scan().unwrap();
    // 15 Hz; 1080 steps of a third of a degree make a turn, and the step is rounded to 1/10000°,
    // one part in 10⁴.
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
    // The first reading, at 90°, is to the left.
    assert_eq!((ranges.len(), ranges[0], ranges[180]), (181, 1.18, 1.0));
    // The first beam of the message was measured last.
    let first_ns = RECEIVED.realtime_ns - 6_000_000;
    assert_eq!(header.stamp.measured_ns, first_ns + 33_333_000);
    let back_ns = (header.time_increment_s * 180.0 * 1e9).round() as i64;
    // Equal up to whole microseconds.
    assert!((header.stamp.measured_ns + back_ns - first_ns).abs() < 1000);
}

#[test]
fn what_makes_no_scan_is_refused() {
    let check = |spoil: fn(&mut World), expected: &str| {
        let mut world = World::default();
        spoil(&mut world);
        let refusal = world.scan().unwrap_err().to_string();
        assert!(refusal.contains(expected), "{refusal}");
    };
    let count = "`count` of channel DIST1 is 0, allowed is at least 1";
    check(|world| world.raw.clear(), count);
    check(|world| world.step = 0, "`angular step`");
    check(|world| world.step = 6000, "`sweep` of channel DIST1 is 486");
    check(|world| world.scale = -1.0, "`scale factor`");
    check(|world| world.scale = f32::NAN, "NaN");
    check(|world| world.layer = 250, "`layer angle`");
    check(|world| world.times_us = [9, 8], "0 to 1 s");
    check(
        |world| world.name = *b"RSSI1",
        "[RSSI1], a scan needs DIST1",
    );
}
