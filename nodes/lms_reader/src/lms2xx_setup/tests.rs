//! The dialogue with a device that executes commands, and with one that does not.

use sick::lms2xx::{Configuration, Unit};

use super::*;

/// Simulated device that executes commands and records them.
struct Simulated {
    baud: Baud,
    port: Baud,
    status: DeviceStatus,
    configuration: Configuration,
    is_there: bool,
    is_willing: bool,
    said: Vec<String>,
}

fn device(baud: Baud) -> Simulated {
    Simulated {
        baud,
        port: Baud::B19200,
        status: DeviceStatus {
            version: *b"V02.10 ",
            mode: 0x24,
            has_error: false,
            turns: 4500,
            range_mode: RangeMode::Range8Fields,
            width_deg: 180,
            resolution_raw_1e2_deg: 100,
            unit: Unit::Centimetre,
        },
        configuration: Configuration::new(RangeMode::Range8Fields, Unit::Centimetre),
        is_there: true,
        is_willing: true,
        said: Vec::new(),
    }
}

impl Simulated {
    fn receive(&mut self, command: &Command<'_>) -> Option<Answer<'static>> {
        if self.port != self.baud || !self.is_there {
            return None;
        }
        self.said.push(format!("{command:?}"));
        Some(match *command {
            Command::SetMode(Mode::Baud(baud)) => {
                self.baud = baud;
                Answer::ModeSet(0)
            }
            Command::SetMode(_) => Answer::ModeSet(0),
            Command::RequestType => Answer::Type(b"LMS200"),
            Command::RequestStatus => Answer::Status(self.status),
            Command::SetVariant {
                width_deg,
                resolution_raw_1e2_deg,
            } => Answer::VariantSet {
                done: self.is_willing,
                width_deg,
                resolution_raw_1e2_deg,
            },
            Command::RequestConfiguration => Answer::Configuration(self.configuration),
            Command::SetConfiguration(configuration) => Answer::ConfigurationSet {
                done: true,
                configuration,
            },
            other => panic!("{other:?}"),
        })
    }
}

impl Device for Simulated {
    fn ask<R>(
        &mut self,
        command: &Command<'static>,
        _: Duration,
        mut pick: impl FnMut(&Answer<'_>) -> Option<R>,
    ) -> Result<Option<R>, LmsError> {
        // The answer to another command changes nothing.
        assert!(pick(&Answer::Other(&[0x92])).is_none());
        Ok(self.receive(command).and_then(|answer| pick(&answer)))
    }

    fn switch(&mut self, baud: Baud) -> Result<(), LmsError> {
        self.port = baud;
        Ok(())
    }
}

#[test]
fn the_baud_rate_is_found_and_nothing_changed() {
    for baud in Baud::ALL {
        let mut device = device(baud);
        assert_eq!(find_baud(&mut device, None, None).unwrap(), baud);
        let expected = Format {
            range_mode: RangeMode::Range8Fields,
            width_deg: 180,
            resolution_raw_1e2_deg: 100,
        };
        let format = set_up(&mut device, Wanted::default()).unwrap();
        assert_eq!((format, device.port), (expected, baud));
        assert_eq!(device.said.len(), 5, "{:#?}", device.said);
    }
}

#[test]
fn requested_settings_are_set_and_read_back() {
    let reach = Reach {
        mode: RangeMode::Range32Field,
        unit: Unit::Millimetre,
    };
    let wanted = Wanted {
        baud: Some(Baud::B500000),
        width_deg: Some(100),
        resolution_raw_1e2_deg: Some(25),
        reach: Some(reach),
    };
    let mut device = device(Baud::B9600);
    let found = find_baud(&mut device, wanted.baud, None).unwrap();
    assert_eq!((found, device.baud), (Baud::B500000, Baud::B500000));
    let expected = Format {
        range_mode: RangeMode::Range32Field,
        width_deg: 100,
        resolution_raw_1e2_deg: 25,
    };
    assert_eq!(set_up(&mut device, wanted).unwrap(), expected);
    let said = device.said.join("\n");
    assert!(
        said.contains("Installation") && said.contains("SetVariant"),
        "{said}"
    );
}

#[test]
fn silence_names_the_rates_that_were_tried() {
    let mut device = device(Baud::B9600);
    device.is_there = false;
    let error = find_baud(&mut device, None, Some(Baud::B500000)).unwrap_err();
    let error = error.to_string();
    assert!(error.contains("(500000, 38400, 9600, 19200)"), "{error}");
}

#[test]
fn a_device_that_refuses_is_an_error() {
    let mut device = device(Baud::B19200);
    device.is_willing = false;
    let wanted = Wanted {
        width_deg: Some(100),
        ..Wanted::default()
    };
    let error = set_up(&mut device, wanted).unwrap_err().to_string();
    assert!(
        error.contains("did not change field and resolution"),
        "{error}"
    );
}
