//! Tests of the device's refusals and of its scan telegrams.

use super::*;
use crate::sweep::five_beams;

fn device() -> ColaDevice {
    device_of("LMS111")
}

fn device_of(name: &str) -> ColaDevice {
    let model = Model::of(Some(KnownDevice::named(name).unwrap()));
    ColaDevice::new(model, Encoding::Binary, &five_beams(1.0))
}

/// Returns the content of the telegram of the first scan.
fn written(device: &mut ColaDevice, counter: u64) -> Vec<u8> {
    let mut bytes = Vec::new();
    device.write_scan(&five_beams(1.0), 0, counter, 9, &mut bytes);
    bytes[8..bytes.len() - 1].to_vec()
}

const LOGIN: Method = Method::SetAccessMode {
    level: AUTHORIZED_CLIENT,
    password: PASSWORD_AUTHORIZED_CLIENT,
};

#[test]
fn nothing_changes_without_a_login() {
    let (mut device, mut session) = (device(), Session::default());
    let range = Command::Write(Value::OutputRange(device.range));
    let set = Command::Call(Method::SetScanConfig(device.scan));
    let wrong = Method::SetAccessMode {
        level: 3,
        password: 1,
    };
    // The client logs out at the end.
    for (command, answer) in [
        (range, Err(Fault::WRITE_DENIED)),
        (set, Err(Fault::METHOD_DENIED)),
        (Command::Call(wrong), Ok(Answer::AccessMode(false))),
        (Command::Call(LOGIN), Ok(Answer::AccessMode(true))),
        (range, Ok(Answer::Written(Variable::OutputRange))),
        (Command::Call(Method::Run), Ok(Answer::Running(true))),
        (range, Err(Fault::WRITE_DENIED)),
    ] {
        assert_eq!(device.obey(&mut session, &command), answer, "{command:?}");
        // Another client has not logged in.
        let other = device.obey(&mut Session::default(), &range);
        assert_eq!(other, Err(Fault::WRITE_DENIED));
    }
}

#[test]
fn what_the_recording_does_not_have_is_refused() {
    let (mut device, mut session) = (device(), Session::default());
    let login = device.obey(&mut session, &Command::Call(LOGIN));
    assert_eq!(login, Ok(Answer::AccessMode(true)));
    let range = OutputRange {
        stop_angle_raw_1e4_deg: 930_000,
        ..device.range
    };
    let write = Command::Write(Value::OutputRange(range));
    let refused = device.obey(&mut session, &write);
    assert_eq!(refused, Err(Fault::OUT_OF_RANGE));
    type Change = fn(&mut ScanConfig);
    let changes: [(u8, Change); 4] = [
        (1, |config| config.frequency_raw_1e2_hz = 1),
        (2, |config| config.range.resolution_raw_1e4_deg = 5000),
        (4, |config| config.range.start_angle_raw_1e4_deg = 0),
        (0, |config| config.range.resolution_raw_1e4_deg = 20_000),
    ];
    for (expected, change) in changes {
        let mut config = device.full;
        change(&mut config);
        let set = Command::Call(Method::SetScanConfig(config));
        match device.obey(&mut session, &set) {
            Ok(Answer::ScanConfigSet { status, .. }) => assert_eq!(status, expected),
            other => panic!("{other:?}"),
        }
    }
}

#[test]
fn unknown_names_are_refused_by_kind() {
    let (mut device, mut session) = (device(), Session::default());
    for (content, fault) in [
        (&b"sRN STlms"[..], Fault::UNKNOWN_VARIABLE),
        (b"sMN mSCreboot", Fault::UNKNOWN_METHOD),
        (b"sEN LIDinputstate", Fault::UNKNOWN_EVENT),
        (b"sXX", Fault::UNKNOWN_COMMAND),
    ] {
        let answer = device.receive(&mut session, &Telegram::Other(content));
        assert_eq!(answer, Some(Answer::Fault(fault)));
    }
}

#[test]
fn scans_are_rounded_to_the_devices_unit() {
    let content = written(&mut device(), 65_537);
    let scan = LmdScanData::read(Encoding::Binary, &content).unwrap();
    let channel = scan.channels_16_bit.named(b"DIST1").unwrap();
    // 70 m needs steps of two millimetres, and a millimetre would be a code.
    assert_eq!(channel.scale_factor, 2.0);
    assert_eq!(
        channel.values.collect::<Vec<_>>(),
        [500, 0, 1002, 35_000, 0]
    );
    assert_eq!(channel.start_angle_raw_1e4_deg, 880_000);
    assert_eq!((channel.step_raw_1e4_deg, scan.scan_counter), (10_000, 1));
    assert_eq!(scan.scan_frequency_raw_1e2_hz, 5000);
}

#[test]
fn other_devices_turn_and_count_otherwise() {
    let scan = |name| {
        let content = written(&mut device_of(name), 0);
        let scan = LmdScanData::read(Encoding::Binary, &content).unwrap();
        let channel = scan.channels_16_bit.named(b"DIST1").unwrap();
        let values: Vec<u16> = channel.values.collect();
        let unix_us = scan.time.and_then(|time| time.unix_us()).unwrap();
        (channel.start_angle_raw_1e4_deg, values, unix_us)
    };
    // The beams are at 88° to 92° in the usual convention.
    let (start, usual, first_us) = scan("LMS111");
    assert_eq!(start, 880_000);
    let (start, values, unix_us) = scan("TiM240");
    assert_eq!((start, &values, unix_us), (-20_000, &usual, first_us));
    let (start, mut values, unix_us) = scan("NAV310");
    values.reverse();
    assert_eq!((start, &values), (1_780_000, &usual));
    // Four of 360 steps at 50 Hz take 222 µs.
    assert_eq!(first_us - unix_us, 222);
}
