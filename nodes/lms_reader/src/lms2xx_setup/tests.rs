//! The dialogue with a device that executes commands, and with one that does not.

use sick::lms2xx::Unit;

use super::*;

/// Simulated device that executes commands and records them.
struct Device {
    baud: Baud,
    port: Baud,
    status: DeviceStatus,
    configuration: Configuration,
    said: Vec<String>,
}

fn device(baud: Baud) -> Device {
    Device {
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
        said: Vec::new(),
    }
}

impl Device {
    fn receive(&mut self, command: &Command<'_>) -> Option<Answer<'static>> {
        if self.port != self.baud {
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
                done: true,
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

    /// Runs the dialogue until the device sends scans.
    fn speak(&mut self, setup: &mut Setup) -> Result<(), LmsError> {
        let mut now_ns = 0;
        while setup.format().is_none() {
            now_ns += TIMEOUT_NS;
            match setup.next(now_ns)? {
                Action::Baud(baud) => self.port = baud,
                Action::Send(command) => {
                    if let Some(answer) = self.receive(&command) {
                        setup.receive(&answer)?;
                    }
                }
                Action::Wait => {}
            }
        }
        Ok(())
    }
}

#[test]
fn the_baud_rate_is_found_and_nothing_changed() {
    for baud in Baud::ALL {
        let mut device = device(baud);
        let mut setup = Setup::new(Wanted::default(), None);
        device.speak(&mut setup).unwrap();
        assert_eq!((setup.baud(), device.port), (Some(baud), baud));
        let expected = Format {
            range_mode: RangeMode::Range8Fields,
            width_deg: 180,
            resolution_raw_1e2_deg: 100,
        };
        assert_eq!(setup.format(), Some(expected));
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
    let mut setup = Setup::new(wanted, None);
    device.speak(&mut setup).unwrap();
    assert_eq!((device.baud, device.port), (Baud::B500000, Baud::B500000));
    let expected = Format {
        range_mode: RangeMode::Range32Field,
        width_deg: 100,
        resolution_raw_1e2_deg: 25,
    };
    assert_eq!(setup.format(), Some(expected));
    let said = device.said.join("\n");
    assert!(
        said.contains("Installation") && said.contains("SetVariant"),
        "{said}"
    );
}

#[test]
fn nobody_there_names_the_rates_that_were_tried() {
    let mut setup = Setup::new(Wanted::default(), Some(Baud::B500000));
    let mut now_ns = 0;
    let error = loop {
        now_ns += TIMEOUT_NS;
        if let Err(error) = setup.next(now_ns) {
            break error.to_string();
        }
    };
    assert!(error.contains("(500000, 38400, 9600, 19200)"), "{error}");
}

#[test]
fn a_device_that_refuses_is_an_error() {
    let mut device = device(Baud::B38400);
    let wanted = Wanted {
        width_deg: Some(100),
        ..Wanted::default()
    };
    let mut setup = Setup::new(wanted, None);
    let error = loop {
        match setup.next(0).unwrap() {
            Action::Baud(baud) => device.port = baud,
            Action::Send(Command::SetVariant { .. }) => {
                break setup.receive(&Answer::VariantSet {
                    done: false,
                    width_deg: 180,
                    resolution_raw_1e2_deg: 100,
                });
            }
            Action::Send(command) => {
                let answer = device.receive(&command).unwrap();
                setup.receive(&answer).unwrap();
            }
            Action::Wait => panic!("nothing to wait for"),
        }
    };
    let error = error.unwrap_err().to_string();
    assert!(
        error.contains("did not change field and resolution"),
        "{error}"
    );
}
