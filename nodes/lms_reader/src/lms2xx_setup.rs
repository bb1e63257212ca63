//! Dialogue that sets up an LMS2xx before it sends scans.
//!
//! The device keeps its baud rate while it is powered, so the rates are tried until it answers.
//! Then it is asked for its type and settings, the settings are changed if the configuration asks
//! for it and read back, and the device is set to send every scan.

use std::fmt::Debug;
use std::time::Duration;

use sick::lms2xx::{Answer, Baud, Command, DEFAULT_PASSWORD, DeviceStatus, Mode, RangeMode};

use crate::{LmsError, Reach, TRIES};

/// Timeout of most answers: two scans may be in transit at 38400 baud.
const TIMEOUT: Duration = Duration::from_millis(700);
/// Timeout while the device writes its memory.
const SLOW: Duration = Duration::from_secs(15);

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

pub(crate) trait Device {
    /// Sends a command, up to [`TRIES`] times, and returns the first result of `pick` for an answer
    /// within `patience`.
    fn ask<R>(
        &mut self,
        command: &Command<'static>,
        patience: Duration,
        pick: impl FnMut(&Answer<'_>) -> Option<R>,
    ) -> Result<Option<R>, LmsError>;

    /// Sets the port to this baud rate.
    fn switch(&mut self, baud: Baud) -> Result<(), LmsError>;
}

/// Finds the baud rate of the device, first `last`, the rate at which it answered before, and
/// changes it to the wanted one.
pub(crate) fn find_baud(
    device: &mut impl Device,
    wanted: Option<Baud>,
    last: Option<Baud>,
) -> Result<Baud, LmsError> {
    let mut rates: Vec<Baud> = Vec::new();
    for rate in [last, wanted].into_iter().flatten().chain(Baud::ALL) {
        if !rates.contains(&rate) {
            rates.push(rate);
        }
    }
    let found = hail(device, &rates)?;
    match wanted.filter(|&wanted| wanted != found) {
        Some(wanted) => {
            set_mode(device, "change its baud rate", Mode::Baud(wanted))?;
            hail(device, &[wanted])
        }
        None => Ok(found),
    }
}

/// Returns the first rate at which the device answers.
fn hail(device: &mut impl Device, rates: &[Baud]) -> Result<Baud, LmsError> {
    for &baud in rates {
        tracing::debug!(baud = baud.rate(), "trying a baud rate");
        device.switch(baud)?;
        // After the answer no scans arrive between the following answers.
        let on_request = Command::SetMode(Mode::OnRequest);
        if device.ask(&on_request, TIMEOUT, mode_set)?.is_some() {
            tracing::info!(baud = baud.rate(), "the device answered");
            return Ok(baud);
        }
    }
    let rates: Vec<String> = rates.iter().map(|baud| baud.rate().to_string()).collect();
    Err(LmsError::Other(format!(
        "no answer at any baud rate ({}); check power, wiring and that no other program uses the \
         port",
        rates.join(", ")
    )))
}

/// Reads and changes the settings of a device whose baud rate is known, and starts the scans.
pub(crate) fn set_up(device: &mut impl Device, wanted: Wanted) -> Result<Format, LmsError> {
    ask(device, Command::RequestType, TIMEOUT, |answer| {
        let Answer::Type(text) = answer else {
            return None;
        };
        tracing::info!(device = %text.escape_ascii(), "device identified");
        Some(())
    })?;
    let status = ask(
        device,
        Command::RequestStatus,
        TIMEOUT,
        |answer| match answer {
            Answer::Status(status) => Some(*status),
            _ => None,
        },
    )?;
    log(&status);
    let variant = (
        wanted.width_deg.unwrap_or(status.width_deg),
        wanted
            .resolution_raw_1e2_deg
            .unwrap_or(status.resolution_raw_1e2_deg),
    );
    if variant != (status.width_deg, status.resolution_raw_1e2_deg) {
        set_variant(device, variant)?;
    }
    let range_mode = set_reach(device, wanted.reach)?;
    set_mode(device, "send scans", Mode::Continuous)?;
    Ok(Format {
        range_mode,
        width_deg: variant.0,
        resolution_raw_1e2_deg: variant.1,
    })
}

fn log(status: &DeviceStatus) {
    tracing::info!(
        version = %status.version.escape_ascii(),
        field_deg = status.width_deg,
        resolution_deg = f64::from(status.resolution_raw_1e2_deg) * 0.01,
        error = status.has_error,
        "device configuration"
    );
}

fn set_variant(device: &mut impl Device, wanted: (u16, u16)) -> Result<(), LmsError> {
    let set = Command::SetVariant {
        width_deg: wanted.0,
        resolution_raw_1e2_deg: wanted.1,
    };
    let (is_done, found) = ask(device, set, TIMEOUT, |answer| match *answer {
        Answer::VariantSet {
            done,
            width_deg,
            resolution_raw_1e2_deg,
        } => Some((done, (width_deg, resolution_raw_1e2_deg))),
        _ => None,
    })?;
    let is_kept = is_done && found == wanted;
    done("change field and resolution", is_kept, &found)
}

/// Changes the range if another one is wanted; returns the measuring mode.
fn set_reach(device: &mut impl Device, wanted: Option<Reach>) -> Result<RangeMode, LmsError> {
    let read = Command::RequestConfiguration;
    let before = ask(device, read, TIMEOUT, |answer| match answer {
        Answer::Configuration(configuration) => Some(*configuration),
        _ => None,
    })?;
    let mut configuration = before;
    if let Some(reach) = wanted {
        (configuration.range_mode, configuration.unit) = (reach.mode, reach.unit);
    }
    if configuration != before {
        let password = DEFAULT_PASSWORD;
        let install = Mode::Installation { password };
        set_mode(device, "enter the installation mode", install)?;
        let set = Command::SetConfiguration(configuration);
        let (is_done, found) = ask(device, set, SLOW, |answer| match answer {
            Answer::ConfigurationSet {
                done,
                configuration,
            } => Some((*done, *configuration)),
            _ => None,
        })?;
        let is_kept = is_done && found == configuration;
        done("change its range", is_kept, &found)?;
    }
    Ok(configuration.range_mode)
}

fn set_mode(device: &mut impl Device, what: &str, mode: Mode) -> Result<(), LmsError> {
    let result = ask(device, Command::SetMode(mode), TIMEOUT, mode_set)?;
    done(what, result == 0, &result)
}

fn mode_set(answer: &Answer<'_>) -> Option<u8> {
    match answer {
        Answer::ModeSet(result) => Some(*result),
        _ => None,
    }
}

/// Sends a command that the device must answer.
fn ask<R>(
    device: &mut impl Device,
    command: Command<'static>,
    patience: Duration,
    pick: impl FnMut(&Answer<'_>) -> Option<R>,
) -> Result<R, LmsError> {
    device.ask(&command, patience, pick)?.ok_or_else(|| {
        LmsError::Other(format!(
            "the device did not answer {command:?}, sent {TRIES} times"
        ))
    })
}

fn done(what: &str, success: bool, found: &impl Debug) -> Result<(), LmsError> {
    if success {
        return Ok(());
    }
    Err(LmsError::Other(format!(
        "the device did not {what}: it answers {found:?}, expected is that it is done"
    )))
}

#[cfg(test)]
mod tests;
