//! Dialogue that sets up a CoLa device before it sends scans.
//!
//! Pure: answers and the time in, the next command out. It asks for the device's identity, changes
//! only what the configuration asks for, reads it back, and subscribes to the scans. Only changes
//! need a login.

use std::collections::VecDeque;

use sick::cola::{
    AUTHORIZED_CLIENT, Answer, Command, DeviceAngles, Field, Method, OutputRange,
    PASSWORD_AUTHORIZED_CLIENT, ScanConfig, ScanDataConfig, Value, Variable, state_word,
};

use crate::LmsError;
use crate::attempts::{Attempt, Attempts, TRIES};

/// Timeout of most answers.
const TIMEOUT_NS: i64 = 1_000_000_000;
/// Timeout while the mirror may have to change its speed.
const SLOW_NS: i64 = 10_000_000_000;

/// Settings that the device must have; the others are left alone.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(crate) struct Wanted {
    /// Width of the field, centred on ahead.
    pub(crate) field_raw_1e4_deg: Option<i32>,
    pub(crate) resolution_raw_1e4_deg: Option<u32>,
    /// True if each scan must contain the time of its measurement.
    pub(crate) time: bool,
}

impl Wanted {
    pub(crate) fn of(field_deg: Option<f64>, resolution_deg: Option<f64>, time: bool) -> Self {
        Wanted {
            time,
            field_raw_1e4_deg: field_deg.map(|deg| (deg * 1e4).round() as i32),
            resolution_raw_1e4_deg: resolution_deg.map(|deg| (deg * 1e4).round() as u32),
        }
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Step {
    Identify,
    AskState,
    Login,
    ReadScanConfig,
    SetResolution,
    CheckResolution,
    /// Runs before the field is changed, since the field shows which way is ahead.
    CheckAhead,
    ReadRange,
    SetRange,
    CheckRange,
    ReadContents,
    /// Skipped if the contents are already as wanted.
    AddTime,
    CheckContents,
    Run,
    Subscribe,
}

#[derive(Debug)]
pub(crate) struct Setup {
    wanted: Wanted,
    /// Convention of the device, from the configuration or its name.
    angles: DeviceAngles,
    is_stated: bool,
    /// Device angle that points ahead, 1/10000°, once it is known.
    ahead_raw: Option<i32>,
    steps: VecDeque<Step>,
    attempts: Attempts,
    scan: Option<ScanConfig>,
    range: Option<OutputRange>,
    contents: Option<ScanDataConfig>,
}

impl Setup {
    pub(crate) fn new(wanted: Wanted, stated: Option<DeviceAngles>) -> Self {
        let mut steps = VecDeque::from([Step::Identify, Step::AskState]);
        if wanted.time {
            steps.push_back(Step::ReadContents);
        }
        let changes = wanted.field_raw_1e4_deg.is_some() || wanted.resolution_raw_1e4_deg.is_some();
        if changes {
            steps.push_back(Step::Login);
        }
        if wanted.resolution_raw_1e4_deg.is_some() {
            steps.extend([Step::ReadScanConfig, Step::SetResolution]);
            steps.push_back(Step::CheckResolution);
        }
        if wanted.field_raw_1e4_deg.is_some() {
            steps.extend([Step::CheckAhead, Step::ReadRange]);
            steps.extend([Step::SetRange, Step::CheckRange]);
        }
        if changes {
            steps.push_back(Step::Run);
        }
        steps.push_back(Step::Subscribe);
        let is_stated = stated.is_some();
        Setup {
            wanted,
            angles: stated.unwrap_or_default(),
            is_stated,
            ahead_raw: None,
            steps,
            attempts: Attempts::default(),
            scan: None,
            range: None,
            contents: None,
        }
    }

    /// Returns the command to send now, if any.
    pub(crate) fn next(&mut self, now_ns: i64) -> Result<Option<Command<'static>>, LmsError> {
        if self.steps.front() == Some(&Step::CheckAhead) && self.find_ahead()? {
            self.advance();
        }
        while let Some(&step) = self.steps.front() {
            let command = self.command(step);
            let patience_ns = if step == Step::SetResolution {
                SLOW_NS
            } else {
                TIMEOUT_NS
            };
            match self.attempts.next(now_ns, patience_ns) {
                Attempt::Send => return Ok(Some(command)),
                Attempt::Wait => return Ok(None),
                Attempt::GiveUp if step.is_optional() => self.advance(),
                Attempt::GiveUp => {
                    return Err(LmsError::NoAnswer {
                        command: format!("{command:?}"),
                        tries: TRIES,
                    });
                }
            }
        }
        Ok(None)
    }

    /// Processes an answer; ignores answers that do not belong to the last command.
    pub(crate) fn receive(&mut self, answer: &Answer<'_>) -> Result<(), LmsError> {
        let Some(&step) = self.steps.front() else {
            return Ok(());
        };
        let received = match (step, answer) {
            (_, Answer::Fault(fault)) if step.is_optional() => {
                tracing::debug!(%fault, ?step, "the device does not report it");
                true
            }
            (_, Answer::Fault(fault)) => {
                return Err(LmsError::Fault {
                    command: format!("{:?}", self.command(step)),
                    fault: *fault,
                });
            }
            (
                Step::Identify,
                Answer::Value(Value::DeviceIdent {
                    name: name_bytes,
                    version,
                }),
            ) => {
                let (name, version) = (name_bytes.escape_ascii(), version.escape_ascii());
                tracing::info!(%name, %version, "device identified");
                if !self.is_stated {
                    self.angles = DeviceAngles::of_name(name_bytes);
                }
                true
            }
            (Step::AskState, Answer::Value(Value::DeviceState(state))) => {
                tracing::info!("device state: {}", state_word(*state));
                true
            }
            (Step::Login, Answer::AccessMode(success)) => done("log in", *success)?,
            (Step::Run, Answer::Running(success)) => done("run", *success)?,
            (Step::Subscribe, Answer::ScansSubscribed(on)) => done("send scans", *on)?,
            _ => self.on_settings(step, answer)?,
        };
        if received {
            self.advance();
        }
        Ok(())
    }

    fn on_settings(&mut self, step: Step, answer: &Answer<'_>) -> Result<bool, LmsError> {
        match (step, answer) {
            (Step::ReadScanConfig, Answer::Value(Value::ScanConfig(config))) => {
                self.scan = Some(*config);
                Ok(true)
            }
            (Step::SetResolution, Answer::ScanConfigSet { status, .. }) => {
                same("change the resolution", status, &0)
            }
            (Step::CheckResolution, Answer::Value(Value::ScanConfig(config))) => {
                let found = Some(config.resolution_raw_1e4_deg);
                same(
                    "keep the resolution",
                    &found,
                    &self.wanted.resolution_raw_1e4_deg,
                )
            }
            (Step::CheckAhead, Answer::Value(Value::ScanConfig(config))) => {
                self.scan = Some(*config);
                self.find_ahead()
            }
            (Step::ReadRange, Answer::Value(Value::OutputRange(range))) => {
                self.range = Some(*range);
                Ok(true)
            }
            (Step::SetRange, Answer::Written(Variable::OutputRange)) => Ok(true),
            (Step::ReadContents, Answer::Value(Value::ScanDataConfig(contents))) => {
                self.on_contents(*contents);
                Ok(true)
            }
            (Step::AddTime, Answer::Written(Variable::ScanDataConfig)) => Ok(true),
            (Step::CheckContents, Answer::Value(Value::ScanDataConfig(contents))) => {
                same("send the time of a scan", &contents.time, &true)
            }
            (Step::CheckRange, Answer::Value(Value::OutputRange(range))) => {
                same("keep the field", &Some(*range), &self.wanted_range())
            }
            _ => Ok(false),
        }
    }

    /// Finds what is ahead by the name, or by the whole field that the device measures. Returns
    /// false if neither is known yet; fails if the convention remains unknown, so that the field is
    /// not changed.
    fn find_ahead(&mut self) -> Result<bool, LmsError> {
        let convention = match (self.angles.certain(), &self.scan) {
            (Some(convention), _) => convention,
            (None, Some(scan)) => self.angles.convention(Field::measured(scan))?,
            (None, None) => return Ok(false),
        };
        self.ahead_raw = Some((convention.ahead_deg * 1e4).round() as i32);
        Ok(true)
    }

    /// Returns true while the device's identity is unknown.
    pub(crate) fn is_identifying(&self) -> bool {
        self.steps.front() == Some(&Step::Identify)
    }

    /// Adds the steps that enable the time, if the device does not send it.
    fn on_contents(&mut self, contents: ScanDataConfig) {
        self.contents = Some(contents);
        if contents.time {
            return;
        }
        let changes = [Step::AddTime, Step::CheckContents];
        let at = match self.steps.iter().position(|&step| step == Step::Login) {
            Some(login) => login + 1,
            None => {
                self.steps.insert(1, Step::Login);
                self.steps.insert(2, Step::Run);
                2
            }
        };
        for step in changes.into_iter().rev() {
            self.steps.insert(at, step);
        }
    }

    pub(crate) fn is_done(&self) -> bool {
        self.steps.is_empty()
    }

    fn advance(&mut self) {
        self.steps.pop_front();
        self.attempts = Attempts::default();
    }

    fn command(&self, step: Step) -> Command<'static> {
        match step {
            Step::Identify => Command::Read(Variable::DeviceIdent),
            Step::AskState => Command::Read(Variable::DeviceState),
            Step::Login => Command::Call(Method::SetAccessMode {
                level: AUTHORIZED_CLIENT,
                password: PASSWORD_AUTHORIZED_CLIENT,
            }),
            Step::ReadScanConfig | Step::CheckResolution | Step::CheckAhead => {
                Command::Read(Variable::ScanConfig)
            }
            Step::SetResolution => self
                .wanted_scan()
                .map_or(Command::Read(Variable::ScanConfig), |config| {
                    Command::Call(Method::SetScanConfig(config))
                }),
            Step::ReadRange | Step::CheckRange => Command::Read(Variable::OutputRange),
            Step::SetRange => match self.wanted_range() {
                Some(range) => Command::Write(Value::OutputRange(range)),
                None => Command::Read(Variable::OutputRange),
            },
            Step::ReadContents | Step::CheckContents => Command::Read(Variable::ScanDataConfig),
            Step::AddTime => match self.contents {
                Some(contents) => Command::Write(Value::ScanDataConfig(ScanDataConfig {
                    time: true,
                    ..contents
                })),
                None => Command::Read(Variable::ScanDataConfig),
            },
            Step::Run => Command::Call(Method::Run),
            Step::Subscribe => Command::SubscribeScans(true),
        }
    }

    fn wanted_scan(&self) -> Option<ScanConfig> {
        Some(ScanConfig {
            resolution_raw_1e4_deg: self.wanted.resolution_raw_1e4_deg?,
            ..self.scan?
        })
    }

    fn wanted_range(&self) -> Option<OutputRange> {
        let half = self.wanted.field_raw_1e4_deg? / 2;
        let ahead_raw = self.ahead_raw?;
        Some(OutputRange {
            start_angle_raw_1e4_deg: ahead_raw - half,
            stop_angle_raw_1e4_deg: ahead_raw + half,
            ..self.range?
        })
    }
}

impl Step {
    /// Returns true if scans can be received without this step.
    fn is_optional(self) -> bool {
        matches!(self, Step::Identify | Step::AskState)
    }
}

fn done(what: &'static str, success: bool) -> Result<bool, LmsError> {
    same(what, &success, &true)
}

fn same<T: PartialEq + std::fmt::Debug>(
    what: &'static str,
    found: &T,
    expected: &T,
) -> Result<bool, LmsError> {
    if found == expected {
        return Ok(true);
    }
    Err(LmsError::Refused {
        what,
        found: format!("{found:?}"),
        expected: format!("{expected:?}"),
    })
}

#[cfg(test)]
mod tests;
