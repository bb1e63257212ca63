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
    let measured = |data: &_| measured_ns(data, &settings, RECEIVED, &mut DeviceClock::default());
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
    // If no option sets it, it is the device's longest range.
    let settings = ScanSettings {
        range_max_m: None,
        ..settings
    };
    let far = header(&data, &channel, angles, &settings, 5, RECEIVED);
    assert_eq!(far.range_max_m, 250.0);
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
