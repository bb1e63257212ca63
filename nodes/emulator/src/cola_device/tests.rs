//! Tests of the device's refusals and of its scan telegrams.

use super::*;
use crate::sweep::five_beams;

fn device() -> ColaDevice {
    ColaDevice::new(model("LMS111"), Encoding::Binary, &five_beams(1.0))
}

fn model(name: &str) -> Model {
    Model::of(Some(KnownDevice::named(name).unwrap()))
}

fn ask(device: &mut ColaDevice, session: &mut Session, command: Command<'_>) -> Answer<'static> {
    device
        .receive(session, &Telegram::Command(command))
        .unwrap()
}

const LOGIN: Command<'_> = Command::Call(Method::SetAccessMode {
    level: AUTHORIZED_CLIENT,
    password: PASSWORD_AUTHORIZED_CLIENT,
});

#[test]
fn nothing_changes_without_a_login() {
    let (mut device, mut session) = (device(), Session::default());
    let range = Command::Write(Value::OutputRange(device.range));
    assert_eq!(
        ask(&mut device, &mut session, range),
        Answer::Fault(Fault::WRITE_DENIED)
    );
    let set = Command::Call(Method::SetScanConfig(device.scan));
    let answer = ask(&mut device, &mut session, set);
    assert_eq!(answer, Answer::Fault(Fault::METHOD_DENIED));
    let wrong = Command::Call(Method::SetAccessMode {
        level: 3,
        password: 1,
    });
    assert_eq!(
        ask(&mut device, &mut session, wrong),
        Answer::AccessMode(false)
    );
    assert_eq!(
        ask(&mut device, &mut session, LOGIN),
        Answer::AccessMode(true)
    );
    let written = Answer::Written(Variable::OutputRange);
    assert_eq!(ask(&mut device, &mut session, range), written);
    // Another client has not logged in, and this client logs out.
    let fault = Answer::Fault(Fault::WRITE_DENIED);
    assert_eq!(ask(&mut device, &mut Session::default(), range), fault);
    ask(&mut device, &mut session, Command::Call(Method::Run));
    assert_eq!(ask(&mut device, &mut session, range), fault);
}

#[test]
fn what_the_recording_does_not_have_is_refused() {
    let (mut device, mut session) = (device(), Session::default());
    ask(&mut device, &mut session, LOGIN);
    let range = OutputRange {
        stop_angle_raw_1e4_deg: 930_000,
        ..device.range
    };
    let write = Command::Write(Value::OutputRange(range));
    assert_eq!(
        ask(&mut device, &mut session, write),
        Answer::Fault(Fault::OUT_OF_RANGE)
    );
    let mut status = |config| match ask(
        &mut device,
        &mut session,
        Command::Call(Method::SetScanConfig(config)),
    ) {
        Answer::ScanConfigSet { status, .. } => status,
        other => panic!("{other:?}"),
    };
    let full = self::device().full;
    assert_eq!(
        status(ScanConfig {
            frequency_raw_1e2_hz: 1,
            ..full
        }),
        1
    );
    assert_eq!(
        status(ScanConfig {
            resolution_raw_1e4_deg: 5000,
            ..full
        }),
        2
    );
    assert_eq!(
        status(ScanConfig {
            start_angle_raw_1e4_deg: 0,
            ..full
        }),
        4
    );
    assert_eq!(
        status(ScanConfig {
            resolution_raw_1e4_deg: 20_000,
            ..full
        }),
        0
    );
}

#[test]
fn unknown_names_are_refused_by_kind() {
    let (mut device, mut session) = (device(), Session::default());
    let mut fault = |content: &[u8]| {
        device
            .receive(&mut session, &Telegram::Other(content))
            .unwrap()
    };
    assert_eq!(fault(b"sRN STlms"), Answer::Fault(Fault::UNKNOWN_VARIABLE));
    assert_eq!(
        fault(b"sMN mSCreboot"),
        Answer::Fault(Fault::UNKNOWN_METHOD)
    );
    assert_eq!(
        fault(b"sEN LIDinputstate"),
        Answer::Fault(Fault::UNKNOWN_EVENT)
    );
    assert_eq!(fault(b"sXX"), Answer::Fault(Fault::UNKNOWN_COMMAND));
}

#[test]
fn scans_are_rounded_to_the_devices_unit() {
    let (mut device, sweep) = (device(), five_beams(1.0));
    let mut content = Vec::new();
    device.write_scan(&sweep, 0, 65_537, 9, &mut content);
    let content = &content[8..content.len() - 1];
    let scan = LmdScanData::read(Encoding::Binary, content).unwrap();
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
    let sweep = five_beams(1.0);
    let scan = |name| {
        let mut device = ColaDevice::new(model(name), Encoding::Binary, &sweep);
        let mut content = Vec::new();
        device.write_scan(&sweep, 0, 0, 9, &mut content);
        let content = &content[8..content.len() - 1];
        let scan = LmdScanData::read(Encoding::Binary, content).unwrap();
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
