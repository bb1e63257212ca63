//! Dialogue that sets up a CoLa device before it sends scans.
//!
//! It asks for the device's identity, changes only what the configuration asks for, reads it back,
//! and subscribes to the scans. Only changes need a login.

use std::fmt::Debug;
use std::time::Duration;

use sick::cola::{
    AUTHORIZED_CLIENT, Answer, Command, DeviceAngles, Field, Method, OutputRange,
    PASSWORD_AUTHORIZED_CLIENT, ScanConfig, ScanDataConfig, Value, Variable, state_word,
};

use crate::{LmsError, TRIES};

/// Timeout of most answers.
const TIMEOUT: Duration = Duration::from_secs(1);
/// Timeout while the mirror may have to change its speed.
const SLOW: Duration = Duration::from_secs(10);

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

pub(crate) trait Device {
    /// Sends a command, up to [`TRIES`] times, and returns the first result of `pick` for an answer
    /// within `patience`.
    fn ask<R>(
        &mut self,
        command: Command<'static>,
        patience: Duration,
        pick: impl FnMut(&Answer<'_>) -> Option<R>,
    ) -> Result<Option<R>, LmsError>;
}

/// Runs the whole dialogue; `stated` is what the configuration says about the device's angles.
pub(crate) fn set_up(
    device: &mut impl Device,
    wanted: Wanted,
    stated: Option<DeviceAngles>,
) -> Result<(), LmsError> {
    let named = device.ask(Command::Read(Variable::DeviceIdent), TIMEOUT, |answer| {
        let Answer::Value(Value::DeviceIdent { name, version }) = answer else {
            return is_rejected(answer).then_some(None);
        };
        let shown = (name.escape_ascii(), version.escape_ascii());
        tracing::info!(name = %shown.0, version = %shown.1, "device identified");
        Some(Some(DeviceAngles::of_name(name)))
    })?;
    device.ask(Command::Read(Variable::DeviceState), TIMEOUT, |answer| {
        let Answer::Value(Value::DeviceState(state)) = answer else {
            return is_rejected(answer).then_some(());
        };
        tracing::info!("device state: {}", state_word(*state));
        Some(())
    })?;
    let angles = stated.or(named.flatten()).unwrap_or_default();
    let without_time = match wanted.time {
        true => Some(contents(device)?).filter(|contents| !contents.time),
        false => None,
    };
    let (field, resolution) = (wanted.field_raw_1e4_deg, wanted.resolution_raw_1e4_deg);
    if without_time.is_some() || field.is_some() || resolution.is_some() {
        let login = Command::Call(Method::SetAccessMode {
            level: AUTHORIZED_CLIENT,
            password: PASSWORD_AUTHORIZED_CLIENT,
        });
        let is_in = ask(device, login, TIMEOUT, |answer| match answer {
            Answer::AccessMode(success) => Some(*success),
            _ => None,
        })?;
        same("log in", &is_in, &true)?;
        if let Some(contents) = without_time {
            add_time(device, contents)?;
        }
        let mut scan = None;
        if let Some(resolution) = resolution {
            scan = Some(set_resolution(device, resolution)?);
        }
        if let Some(field) = field {
            let ahead_raw = ahead_raw(device, &angles, scan)?;
            set_field(device, ahead_raw, field)?;
        }
        let runs = ask(
            device,
            Command::Call(Method::Run),
            TIMEOUT,
            |answer| match answer {
                Answer::Running(success) => Some(*success),
                _ => None,
            },
        )?;
        same("run", &runs, &true)?;
    }
    let subscribe = Command::SubscribeScans(true);
    let on = ask(device, subscribe, TIMEOUT, |answer| match answer {
        Answer::ScansSubscribed(on) => Some(*on),
        _ => None,
    })?;
    same("send scans", &on, &true)
}

fn is_rejected(answer: &Answer<'_>) -> bool {
    matches!(answer, Answer::Fault(_))
}

/// Sends a command that the device must carry out.
fn ask<R>(
    device: &mut impl Device,
    command: Command<'static>,
    patience: Duration,
    mut pick: impl FnMut(&Answer<'_>) -> Option<R>,
) -> Result<R, LmsError> {
    let answer = device.ask(command, patience, |answer| match answer {
        Answer::Fault(fault) => Some(Err(*fault)),
        other => pick(other).map(Ok),
    })?;
    let problem = match answer {
        Some(Ok(found)) => return Ok(found),
        Some(Err(fault)) => format!("the device rejects {command:?} with CoLa error {fault}"),
        None => format!("the device did not answer {command:?}, sent {TRIES} times"),
    };
    Err(LmsError::Other(problem))
}

fn write(device: &mut impl Device, value: Value<'static>) -> Result<(), LmsError> {
    ask(device, Command::Write(value), TIMEOUT, |answer| {
        (*answer == Answer::Written(value.variable())).then_some(())
    })
}

fn contents(device: &mut impl Device) -> Result<ScanDataConfig, LmsError> {
    let read = Command::Read(Variable::ScanDataConfig);
    ask(device, read, TIMEOUT, |answer| match answer {
        Answer::Value(Value::ScanDataConfig(contents)) => Some(*contents),
        _ => None,
    })
}

fn scan_config(device: &mut impl Device) -> Result<ScanConfig, LmsError> {
    let read = Command::Read(Variable::ScanConfig);
    ask(device, read, TIMEOUT, |answer| match answer {
        Answer::Value(Value::ScanConfig(config)) => Some(*config),
        _ => None,
    })
}

fn output_range(device: &mut impl Device) -> Result<OutputRange, LmsError> {
    let read = Command::Read(Variable::OutputRange);
    ask(device, read, TIMEOUT, |answer| match answer {
        Answer::Value(Value::OutputRange(range)) => Some(*range),
        _ => None,
    })
}

fn add_time(device: &mut impl Device, before: ScanDataConfig) -> Result<(), LmsError> {
    let wanted = ScanDataConfig {
        time: true,
        ..before
    };
    write(device, Value::ScanDataConfig(wanted))?;
    same("send the time of a scan", &contents(device)?.time, &true)
}

fn set_resolution(device: &mut impl Device, resolution: u32) -> Result<ScanConfig, LmsError> {
    let mut wanted = scan_config(device)?;
    wanted.range.resolution_raw_1e4_deg = resolution;
    let set = Command::Call(Method::SetScanConfig(wanted));
    let status = ask(device, set, SLOW, |answer| match answer {
        Answer::ScanConfigSet { status, .. } => Some(*status),
        _ => None,
    })?;
    same("change the resolution", &status, &0)?;
    let found = scan_config(device)?;
    same(
        "keep the resolution",
        &found.range.resolution_raw_1e4_deg,
        &resolution,
    )?;
    Ok(found)
}

/// Returns the device angle that points ahead, 1/10000°, by the name or by the whole field that the
/// device measures; fails if it remains unknown, so that the field is not changed.
fn ahead_raw(
    device: &mut impl Device,
    angles: &DeviceAngles,
    scan: Option<ScanConfig>,
) -> Result<i32, LmsError> {
    let convention = match (angles.certain(), scan) {
        (Some(convention), _) => Ok(convention),
        (None, Some(scan)) => angles.convention(Field::measured(&scan.range)),
        (None, None) => angles.convention(Field::measured(&scan_config(device)?.range)),
    };
    let convention = convention.map_err(LmsError::Other)?;
    Ok((convention.ahead_deg * 1e4).round() as i32)
}

fn set_field(device: &mut impl Device, ahead_raw: i32, field: i32) -> Result<(), LmsError> {
    let wanted = OutputRange {
        start_angle_raw_1e4_deg: ahead_raw - field / 2,
        stop_angle_raw_1e4_deg: ahead_raw + field / 2,
        ..output_range(device)?
    };
    write(device, Value::OutputRange(wanted))?;
    same("keep the field", &output_range(device)?, &wanted)
}

fn same<T: PartialEq + Debug>(what: &str, found: &T, expected: &T) -> Result<(), LmsError> {
    if found == expected {
        return Ok(());
    }
    Err(LmsError::Other(format!(
        "the device did not {what}: it answers {found:?}, expected is {expected:?}"
    )))
}

#[cfg(test)]
mod tests;
