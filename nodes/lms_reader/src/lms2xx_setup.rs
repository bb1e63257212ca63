//! Dialogue that sets up an LMS2xx before it sends scans.
//!
//! Pure: answers and the time in, the next action out. The device keeps its baud rate while it is
//! powered, so the rates are tried until it answers. Then it is asked for its type and settings,
//! the settings are changed if the configuration asks for it and read back, and the device is set
//! to send every scan.

use std::collections::VecDeque;

use sick::lms2xx::{
    Answer, Baud, Command, Configuration, DEFAULT_PASSWORD, DeviceStatus, Mode, RangeMode,
};

use crate::attempts::{Attempt, Attempts, TRIES};
use crate::{LmsError, Reach};

/// Timeout of most answers: two scans may be in transit at 38400 baud.
const TIMEOUT_NS: i64 = 700_000_000;
/// Timeout while the device writes its memory.
const SLOW_NS: i64 = 15_000_000_000;

/// Settings that the device must have; the others are left alone.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Wanted {
    pub(crate) baud: Option<Baud>,
    pub(crate) width_deg: Option<u16>,
    pub(crate) resolution_raw_1e2_deg: Option<u16>,
    pub(crate) reach: Option<Reach>,
}

/// Measuring mode, width and resolution of the device's scans.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Format {
    pub(crate) range_mode: RangeMode,
    pub(crate) width_deg: u16,
    pub(crate) resolution_raw_1e2_deg: u16,
}

#[derive(Debug, PartialEq, Eq)]
pub(crate) enum Action {
    Send(Command<'static>),
    /// Set the port to this baud rate.
    Baud(Baud),
    Wait,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Step {
    /// Set the port to this baud rate.
    Try(Baud),
    Hail,
    SwitchBaud(Baud),
    AskType,
    AskStatus,
    SetVariant,
    AskConfiguration,
    Install,
    SetConfiguration,
    Start,
}

#[derive(Debug)]
pub(crate) struct Setup {
    wanted: Wanted,
    steps: VecDeque<Step>,
    attempts: Attempts,
    /// Rates not tried yet.
    rates: VecDeque<Baud>,
    tried: Vec<u32>,
    baud: Option<Baud>,
    status: Option<DeviceStatus>,
    configuration: Option<Configuration>,
}

impl Setup {
    /// Creates the dialogue; `last` is the rate at which the device answered before.
    pub(crate) fn new(wanted: Wanted, last: Option<Baud>) -> Self {
        let mut rates = VecDeque::new();
        for rate in [last, wanted.baud].into_iter().flatten().chain(Baud::ALL) {
            if !rates.contains(&rate) {
                rates.push_back(rate);
            }
        }
        Setup {
            wanted,
            steps: VecDeque::new(),
            attempts: Attempts::default(),
            rates,
            tried: Vec::new(),
            baud: None,
            status: None,
            configuration: None,
        }
    }

    pub(crate) fn next(&mut self, now_ns: i64) -> Result<Action, LmsError> {
        if self.baud.is_none() && self.steps.is_empty() {
            self.try_another_rate()?;
        }
        let Some(&step) = self.steps.front() else {
            return Ok(Action::Wait);
        };
        if let Step::Try(baud) = step {
            self.advance();
            return Ok(Action::Baud(baud));
        }
        let patience_ns = match step {
            Step::SetConfiguration => SLOW_NS,
            _ => TIMEOUT_NS,
        };
        let command = self.command(step);
        match self.attempts.next(now_ns, patience_ns) {
            Attempt::Send => Ok(Action::Send(command)),
            Attempt::Wait => Ok(Action::Wait),
            Attempt::GiveUp if self.baud.is_none() => {
                self.steps.clear();
                self.next(now_ns)
            }
            Attempt::GiveUp => Err(LmsError::NoAnswer {
                command: format!("{command:?}"),
                tries: TRIES,
            }),
        }
    }

    fn try_another_rate(&mut self) -> Result<(), LmsError> {
        let Some(baud) = self.rates.pop_front() else {
            return Err(LmsError::NoBaud {
                rates: std::mem::take(&mut self.tried),
            });
        };
        tracing::debug!(baud = baud.rate(), "trying a baud rate");
        self.tried.push(baud.rate());
        self.steps = VecDeque::from([Step::Try(baud), Step::Hail]);
        self.attempts = Attempts::default();
        Ok(())
    }

    /// Processes an answer; ignores answers that do not belong to the last command.
    pub(crate) fn receive(&mut self, answer: &Answer<'_>) -> Result<(), LmsError> {
        let Some(&step) = self.steps.front() else {
            return Ok(());
        };
        match (step, answer) {
            (Step::Hail, Answer::ModeSet(_)) => self.hailed(),
            (Step::SwitchBaud(baud), Answer::ModeSet(result)) => {
                done("change its baud rate", *result == 0, result)?;
                self.steps = VecDeque::from([Step::SwitchBaud(baud), Step::Try(baud), Step::Hail]);
                self.rates = VecDeque::from([baud]);
                self.tried.push(baud.rate());
                self.baud = None;
            }
            (Step::AskType, Answer::Type(text)) => {
                tracing::info!(device = %text.escape_ascii(), "device identified");
            }
            (Step::AskStatus, Answer::Status(status)) => self.on_status(status),
            (
                Step::SetVariant,
                &Answer::VariantSet {
                    done: is_done,
                    width_deg,
                    resolution_raw_1e2_deg,
                },
            ) => {
                let found = (width_deg, resolution_raw_1e2_deg);
                let kept = Some(found) == self.wanted_variant();
                done("change field and resolution", is_done && kept, &found)?;
                if let Some(status) = &mut self.status {
                    (status.width_deg, status.resolution_raw_1e2_deg) = found;
                }
            }
            (Step::AskConfiguration, Answer::Configuration(configuration)) => {
                self.on_configuration(*configuration);
            }
            (Step::Install, Answer::ModeSet(result)) => {
                done("enter the installation mode", *result == 0, result)?;
            }
            (
                Step::SetConfiguration,
                Answer::ConfigurationSet {
                    done: is_done,
                    configuration,
                },
            ) => {
                let kept = Some(*configuration) == self.wanted_configuration();
                done("change its range", *is_done && kept, configuration)?;
                self.configuration = Some(*configuration);
            }
            (Step::Start, Answer::ModeSet(result)) => done("send scans", *result == 0, result)?,
            _ => return Ok(()),
        }
        self.advance();
        Ok(())
    }

    fn hailed(&mut self) {
        let found = self.tried.last().copied().and_then(Baud::from_rate);
        self.baud = found;
        tracing::info!(baud = found.map(Baud::rate), "the device answered");
        self.steps = match self.wanted.baud {
            Some(wanted) if found != Some(wanted) => {
                VecDeque::from([Step::Hail, Step::SwitchBaud(wanted)])
            }
            _ => VecDeque::from([
                Step::Hail,
                Step::AskType,
                Step::AskStatus,
                Step::AskConfiguration,
                Step::Start,
            ]),
        };
    }

    fn on_status(&mut self, status: &DeviceStatus) {
        self.status = Some(*status);
        if self.wanted_variant() != Some((status.width_deg, status.resolution_raw_1e2_deg)) {
            self.steps.insert(1, Step::SetVariant);
        }
        tracing::info!(
            version = %status.version.escape_ascii(),
            field_deg = status.width_deg,
            resolution_deg = f64::from(status.resolution_raw_1e2_deg) * 0.01,
            error = status.has_error,
            "device configuration"
        );
    }

    fn on_configuration(&mut self, configuration: Configuration) {
        self.configuration = Some(configuration);
        if self.wanted_configuration() != Some(configuration) {
            self.steps.insert(1, Step::Install);
            self.steps.insert(2, Step::SetConfiguration);
        }
    }

    /// Returns the format of the scans once the device sends them.
    pub(crate) fn format(&self) -> Option<Format> {
        if self.baud.is_none() || !self.steps.is_empty() {
            return None;
        }
        let status = self.status?;
        Some(Format {
            range_mode: self.configuration?.range_mode,
            width_deg: status.width_deg,
            resolution_raw_1e2_deg: status.resolution_raw_1e2_deg,
        })
    }

    pub(crate) fn baud(&self) -> Option<Baud> {
        self.baud
    }

    fn advance(&mut self) {
        self.steps.pop_front();
        self.attempts = Attempts::default();
    }

    fn command(&self, step: Step) -> Command<'static> {
        match step {
            // The device answers this, and then no scans arrive between the following answers.
            Step::Try(_) | Step::Hail => Command::SetMode(Mode::OnRequest),
            Step::SwitchBaud(baud) => Command::SetMode(Mode::Baud(baud)),
            Step::AskType => Command::RequestType,
            Step::AskStatus => Command::RequestStatus,
            Step::SetVariant => match self.wanted_variant() {
                Some((width_deg, resolution_raw_1e2_deg)) => Command::SetVariant {
                    width_deg,
                    resolution_raw_1e2_deg,
                },
                None => Command::RequestStatus,
            },
            Step::AskConfiguration => Command::RequestConfiguration,
            Step::Install => Command::SetMode(Mode::Installation {
                password: DEFAULT_PASSWORD,
            }),
            Step::SetConfiguration => match self.wanted_configuration() {
                Some(configuration) => Command::SetConfiguration(configuration),
                None => Command::RequestConfiguration,
            },
            Step::Start => Command::SetMode(Mode::Continuous),
        }
    }

    fn wanted_variant(&self) -> Option<(u16, u16)> {
        let status = self.status?;
        let resolution = self.wanted.resolution_raw_1e2_deg;
        Some((
            self.wanted.width_deg.unwrap_or(status.width_deg),
            resolution.unwrap_or(status.resolution_raw_1e2_deg),
        ))
    }

    fn wanted_configuration(&self) -> Option<Configuration> {
        let mut configuration = self.configuration?;
        if let Some(reach) = self.wanted.reach {
            configuration.range_mode = reach.mode;
            configuration.unit = reach.unit;
        }
        Some(configuration)
    }
}

fn done(what: &'static str, success: bool, found: &impl std::fmt::Debug) -> Result<(), LmsError> {
    if success {
        return Ok(());
    }
    Err(LmsError::Refused {
        what,
        found: format!("{found:?}"),
        expected: "that it is done".into(),
    })
}

#[cfg(test)]
mod tests;
