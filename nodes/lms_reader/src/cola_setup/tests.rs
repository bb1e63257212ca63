use sick::cola::Fault;

use super::*;

const SCAN: ScanConfig = ScanConfig {
    frequency_raw_1e2_hz: 2500,
    range: OutputRange {
        resolution_raw_1e4_deg: 2500,
        ..RANGE
    },
};
const RANGE: OutputRange = OutputRange {
    resolution_raw_1e4_deg: 5000,
    start_angle_raw_1e4_deg: -450_000,
    stop_angle_raw_1e4_deg: 2_250_000,
};
const UNKNOWN: Answer<'static> = Answer::Fault(Fault::UNKNOWN_VARIABLE);

/// Simulated device that applies all requested settings, except for commands to which `answers` has
/// another answer, or `None` for silence.
struct Simulated {
    name: &'static [u8],
    scan: ScanConfig,
    output: OutputRange,
    contents: ScanDataConfig,
    answers: fn(&Command<'_>) -> Option<Option<Answer<'static>>>,
    said: Vec<String>,
}

fn device(name: &'static [u8]) -> Simulated {
    Simulated {
        name,
        scan: SCAN,
        output: RANGE,
        contents: ScanDataConfig::DISTANCES,
        answers: |_| None,
        said: Vec::new(),
    }
}

impl Simulated {
    fn obey(&mut self, command: Command<'static>) -> Answer<'static> {
        match command {
            Command::Read(variable) => Answer::Value(match variable {
                Variable::DeviceIdent => Value::DeviceIdent {
                    name: self.name,
                    version: b"1",
                },
                Variable::DeviceState => Value::DeviceState(1),
                Variable::ScanConfig => Value::ScanConfig(self.scan),
                Variable::OutputRange => Value::OutputRange(self.output),
                Variable::ScanDataConfig => Value::ScanDataConfig(self.contents),
                Variable::HostEncoding => Value::HostEncoding(true),
            }),
            Command::Call(Method::SetAccessMode { .. }) => Answer::AccessMode(true),
            Command::Call(Method::SetScanConfig(config)) => {
                self.scan = config;
                Answer::ScanConfigSet { status: 0, config }
            }
            Command::Call(Method::Run) => Answer::Running(true),
            Command::Write(value) => {
                match value {
                    Value::OutputRange(wanted) => self.output = wanted,
                    Value::ScanDataConfig(wanted) => self.contents = wanted,
                    other => panic!("{other:?}"),
                }
                Answer::Written(value.variable())
            }
            Command::SubscribeScans(on) => Answer::ScansSubscribed(on),
        }
    }

    /// Runs the dialogue; returns the commands.
    fn play(&mut self, wanted: Wanted) -> Result<&[String], LmsError> {
        set_up(self, wanted, None).map(|()| &self.said[..])
    }

    fn refuses(&mut self, wanted: Wanted, expected: &[&str]) {
        let error = self.play(wanted).unwrap_err().to_string();
        for part in expected {
            assert!(error.contains(part), "{error}");
        }
    }
}

impl Device for Simulated {
    fn ask<R>(
        &mut self,
        command: Command<'static>,
        _: Duration,
        mut pick: impl FnMut(&Answer<'_>) -> Option<R>,
    ) -> Result<Option<R>, LmsError> {
        self.said.push(format!("{command:?}"));
        let other = (self.answers)(&command);
        let answer = other.unwrap_or_else(|| Some(self.obey(command)));
        // The answer to another command changes nothing.
        assert!(pick(&Answer::Value(Value::HostEncoding(true))).is_none());
        Ok(answer.and_then(|answer| pick(&answer)))
    }
}

const FIELD: Wanted = Wanted {
    field_raw_1e4_deg: Some(1_800_000),
    resolution_raw_1e4_deg: None,
    time: false,
};

#[test]
fn without_requests_nothing_is_changed() {
    for unknown in [Some(UNKNOWN), None] {
        let mut device = device(b"LMS111");
        device.answers = match unknown {
            Some(_) => |command| is_optional(command).then_some(Some(UNKNOWN)),
            None => |command| is_optional(command).then_some(None),
        };
        let said = device.play(Wanted::default()).unwrap();
        let expected = ["DeviceIdent", "DeviceState", "SubscribeScans(true)"];
        assert_eq!(said.len(), 3, "{said:#?}");
        assert!(said.iter().zip(expected).all(|(said, e)| said.contains(e)));
    }
}

fn is_optional(command: &Command<'_>) -> bool {
    matches!(
        command,
        Command::Read(Variable::DeviceIdent | Variable::DeviceState)
    )
}

#[test]
fn requested_settings_are_set_and_read_back() {
    let mut device = device(b"LMS111");
    let said = device
        .play(Wanted::of(Some(180.0), Some(0.5), false))
        .unwrap();
    assert_eq!(said.len(), 11, "{said:#?}");
    assert!(said[4].contains("resolution_raw_1e4_deg: 5000"));
    assert!(said[4].contains("frequency_raw_1e2_hz: 2500"), "{said:#?}");
    assert!(said[7].contains("start_angle_raw_1e4_deg: 0, stop_angle_raw_1e4_deg: 1800000"));
}

#[test]
fn the_time_of_a_scan_is_asked_for_where_it_is_left_out() {
    let time = Wanted::of(None, None, true);
    let mut sound = device(b"LMS111");
    let said = sound.play(time).unwrap();
    // Identity, state, contents, login, change, check, run, scans.
    assert_eq!(said.len(), 8, "{said:#?}");
    assert!(said[3].contains("SetAccessMode"), "{said:#?}");
    assert!(said[4].contains("Write") && said[4].contains("time: true"));
    let mut sound = device(b"LMS111");
    let said = sound
        .play(Wanted {
            time: true,
            ..FIELD
        })
        .unwrap();
    let logins = said.iter().filter(|said| said.contains("SetAccessMode"));
    assert_eq!((logins.count(), said.len()), (1, 11), "{said:#?}");
    let mut sending = device(b"LMS111");
    sending.contents.time = true;
    assert_eq!(sending.play(time).unwrap().len(), 4);
}

#[test]
fn refusals_and_silence_name_the_command() {
    let refuses = |answers, expected: &[&str]| {
        let mut device = device(b"LMS111");
        device.answers = answers;
        device.refuses(FIELD, expected);
    };
    refuses(
        |command| {
            let is_write = matches!(command, Command::Write(_));
            is_write.then_some(Some(Answer::Written(Variable::OutputRange)))
        },
        &["did not keep the field"],
    );
    refuses(
        |command| is_login(command).then_some(Some(Answer::AccessMode(false))),
        &["did not log in: it answers false"],
    );
    refuses(
        |command| is_login(command).then_some(Some(Answer::Fault(Fault::METHOD_DENIED))),
        &["SetAccessMode", "does not allow this method"],
    );
    refuses(
        |command| is_login(command).then_some(None),
        &["SetAccessMode", "3 times"],
    );
}

fn is_login(command: &Command<'_>) -> bool {
    matches!(command, Command::Call(Method::SetAccessMode { .. }))
}

#[test]
fn a_field_is_laid_around_what_is_ahead_on_that_device() {
    let wanted = Wanted::of(Some(90.0), None, false);
    let is_at = |name, stated, start: i32, stop: i32| {
        let mut device = device(name);
        set_up(&mut device, wanted, stated).unwrap();
        let range = device.output;
        let found = (range.start_angle_raw_1e4_deg, range.stop_angle_raw_1e4_deg);
        assert_eq!(found, (start, stop));
    };
    is_at(b"LMS111", None, 450_000, 1_350_000);
    is_at(b"TiM240", None, -450_000, 450_000);
    let stated = Some(DeviceAngles::of_name(b"TiM240"));
    is_at(b"LMS111", stated, -450_000, 450_000);
    // The field is centred on 90°, which is ahead on most devices.
    is_at(b"XY7", None, 450_000, 1_350_000);
}

#[test]
fn an_unknown_device_that_looks_elsewhere_is_not_changed() {
    let mut device = device(b"XY7");
    device.scan.range.start_angle_raw_1e4_deg = -1_200_000;
    device.scan.range.stop_angle_raw_1e4_deg = 1_200_000;
    device.refuses(FIELD, &["--zero-deg"]);
    assert!(!device.said.iter().any(|said| said.contains("Write")));
}
