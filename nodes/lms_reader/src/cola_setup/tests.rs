use sick::cola::Fault;

use super::*;

const SCAN: ScanConfig = ScanConfig {
    frequency_raw_1e2_hz: 2500,
    resolution_raw_1e4_deg: 2500,
    start_angle_raw_1e4_deg: -450_000,
    stop_angle_raw_1e4_deg: 2_250_000,
};
const RANGE: OutputRange = OutputRange {
    resolution_raw_1e4_deg: 5000,
    start_angle_raw_1e4_deg: -450_000,
    stop_angle_raw_1e4_deg: 2_250_000,
};
const UNKNOWN: Answer<'static> = Answer::Fault(Fault::UNKNOWN_VARIABLE);

const CONTENTS: ScanDataConfig = ScanDataConfig::DISTANCES;

#[test]
fn without_requests_nothing_is_changed() {
    let mut setup = Setup::new(Wanted::default(), None);
    let ident = Command::Read(Variable::DeviceIdent);
    assert_eq!(setup.next(0).unwrap(), Some(ident));
    assert_eq!(setup.next(1).unwrap(), None);
    setup.receive(&UNKNOWN).unwrap();
    let state = Command::Read(Variable::DeviceState);
    assert_eq!(setup.next(2).unwrap(), Some(state));
    setup
        .receive(&Answer::Value(Value::DeviceState(1)))
        .unwrap();
    let subscribe = Command::SubscribeScans(true);
    assert_eq!(setup.next(3).unwrap(), Some(subscribe));
    // The answer to another command changes nothing.
    setup.receive(&Answer::Running(true)).unwrap();
    assert!(!setup.is_done());
    setup.receive(&Answer::ScansSubscribed(true)).unwrap();
    assert!(setup.is_done());
    assert_eq!(setup.next(i64::MAX).unwrap(), None);
}

/// Simulates a device of this name that applies all requested settings, but reports `range` if
/// given.
fn play(
    name: &[u8],
    setup: &mut Setup,
    range: Option<OutputRange>,
) -> Result<Vec<String>, LmsError> {
    let (mut scan, mut output, mut contents) = (SCAN, RANGE, CONTENTS);
    let mut said = Vec::new();
    while let Some(command) = setup.next(0)? {
        said.push(format!("{command:?}"));
        setup.receive(&match command {
            Command::Read(Variable::DeviceIdent) => Answer::Value(Value::DeviceIdent {
                name,
                version: b"1",
            }),
            Command::Read(Variable::DeviceState) => Answer::Value(Value::DeviceState(1)),
            Command::Read(Variable::ScanConfig) => Answer::Value(Value::ScanConfig(scan)),
            Command::Read(Variable::OutputRange) => Answer::Value(Value::OutputRange(output)),
            Command::Call(Method::SetAccessMode { .. }) => Answer::AccessMode(true),
            Command::Call(Method::SetScanConfig(config)) => {
                scan = config;
                Answer::ScanConfigSet { status: 0, config }
            }
            Command::Write(Value::OutputRange(wanted)) => {
                output = range.unwrap_or(wanted);
                Answer::Written(Variable::OutputRange)
            }
            Command::Read(Variable::ScanDataConfig) => {
                Answer::Value(Value::ScanDataConfig(contents))
            }
            Command::Write(Value::ScanDataConfig(wanted)) => {
                contents = wanted;
                Answer::Written(Variable::ScanDataConfig)
            }
            Command::Call(Method::Run) => Answer::Running(true),
            Command::SubscribeScans(on) => Answer::ScansSubscribed(on),
            other => panic!("{other:?}"),
        })?;
    }
    Ok(said)
}

#[test]
fn requested_settings_are_set_and_read_back() {
    let mut setup = Setup::new(Wanted::of(Some(180.0), Some(0.5), false), None);
    let said = play(b"LMS111", &mut setup, None).unwrap();
    assert_eq!(said.len(), 11, "{said:#?}");
    assert!(
        said[4].contains("resolution_raw_1e4_deg: 5000"),
        "{said:#?}"
    );
    assert!(said[4].contains("frequency_raw_1e2_hz: 2500"), "{said:#?}");
    assert!(said[7].contains("start_angle_raw_1e4_deg: 0, stop_angle_raw_1e4_deg: 1800000"));
    assert!(setup.is_done());
}

#[test]
fn the_time_of_a_scan_is_asked_for_where_it_is_left_out() {
    let mut setup = Setup::new(Wanted::of(None, None, true), None);
    let said = play(b"LMS111", &mut setup, None).unwrap();
    // Identity, state, contents, login, change, check, run, scans.
    assert_eq!(said.len(), 8, "{said:#?}");
    assert!(said[3].contains("SetAccessMode"), "{said:#?}");
    assert!(said[4].contains("Write") && said[4].contains("time: true"));
    assert!(setup.is_done());
    let mut setup = Setup::new(Wanted::of(Some(180.0), None, true), None);
    let said = play(b"LMS111", &mut setup, None).unwrap();
    let logins = said.iter().filter(|said| said.contains("SetAccessMode"));
    assert_eq!((logins.count(), said.len()), (1, 11), "{said:#?}");
}

/// Gives an answer to the next command.
fn answer(setup: &mut Setup, answer: &Answer<'_>) -> Result<(), LmsError> {
    setup.next(0)?;
    setup.receive(answer)
}

#[test]
fn a_device_that_sends_the_time_already_is_not_changed() {
    let mut setup = Setup::new(Wanted::of(None, None, true), None);
    let contents = Value::ScanDataConfig(ScanDataConfig {
        time: true,
        ..CONTENTS
    });
    for said in [UNKNOWN, UNKNOWN, Answer::Value(contents)] {
        answer(&mut setup, &said).unwrap();
    }
    let subscribe = Command::SubscribeScans(true);
    assert_eq!(setup.next(0).unwrap(), Some(subscribe));
}

#[test]
fn a_device_that_keeps_its_own_settings_is_an_error() {
    let mut setup = Setup::new(Wanted::of(Some(180.0), None, false), None);
    let error = play(b"LMS111", &mut setup, Some(RANGE))
        .unwrap_err()
        .to_string();
    assert!(error.contains("did not keep the field"), "{error}");
}

#[test]
fn refusals_and_silence_name_the_command() {
    let mut setup = Setup::new(Wanted::of(Some(180.0), None, false), None);
    let mut receive = |said| answer(&mut setup, &said);
    receive(UNKNOWN).unwrap();
    receive(UNKNOWN).unwrap();
    let error = receive(Answer::AccessMode(false)).unwrap_err().to_string();
    assert!(
        error.contains("did not log in: it answers false"),
        "{error}"
    );
    let error = receive(Answer::Fault(Fault::METHOD_DENIED)).unwrap_err();
    let error = error.to_string();
    assert!(error.contains("SetAccessMode"), "{error}");
    assert!(error.contains("does not allow this method"), "{error}");
    let mut now_ns = 0;
    let error = loop {
        now_ns += SLOW_NS;
        if let Err(error) = setup.next(now_ns) {
            break error.to_string();
        }
    };
    assert!(
        error.contains("SetAccessMode") && error.contains("3 times"),
        "{error}"
    );
}

#[test]
fn a_field_is_laid_around_what_is_ahead_on_that_device() {
    let wanted = Wanted::of(Some(90.0), None, false);
    let written = |name, stated| {
        let said = play(name, &mut Setup::new(wanted, stated), None).unwrap();
        said.into_iter()
            .find(|said| said.contains("Write"))
            .unwrap()
    };
    let is_at = |text: &str, start: i32, stop: i32| {
        let (start, stop) = (
            format!("start_angle_raw_1e4_deg: {start},"),
            format!("stop_angle_raw_1e4_deg: {stop}"),
        );
        assert!(text.contains(&start) && text.contains(&stop), "{text}");
    };
    is_at(&written(b"LMS111", None), 450_000, 1_350_000);
    is_at(&written(b"TiM240", None), -450_000, 450_000);
    let stated = Some(DeviceAngles::of_name(b"TiM240"));
    is_at(&written(b"LMS111", stated), -450_000, 450_000);
    // The field is centred on 90°, which is ahead on most devices.
    is_at(&written(b"XY7", None), 450_000, 1_350_000);
}

#[test]
fn an_unknown_device_that_looks_elsewhere_is_not_changed() {
    let wanted = Wanted::of(Some(90.0), None, false);
    let mut setup = Setup::new(wanted, None);
    let mut receive = |said| answer(&mut setup, &said);
    receive(UNKNOWN).unwrap();
    receive(UNKNOWN).unwrap();
    receive(Answer::AccessMode(true)).unwrap();
    let around_zero = ScanConfig {
        start_angle_raw_1e4_deg: -1_200_000,
        stop_angle_raw_1e4_deg: 1_200_000,
        ..SCAN
    };
    let error = receive(Answer::Value(Value::ScanConfig(around_zero))).unwrap_err();
    assert!(error.to_string().contains("--zero-deg"), "{error}");
}
