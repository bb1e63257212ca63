//! Probes a device that speaks CoLa, in both encodings and on its usual ports.

use std::net::Ipv6Addr;
use std::time::Duration;

use anyhow::Context;
use sick::cola::{
    AngleConvention, Answer, Channel, Command, DeviceAngles, Encoding, Field, Framer, OutputRange,
    Telegram, Value, Variable, state_word,
};

use super::error::{not_reached, not_understood};
use super::line::Line;
use super::picture::Seen;

/// Ports of devices, in the order of trying.
const PORTS: [u16; 2] = [2112, 2111];
/// Longest wait for an answer.
const TIMEOUT: Duration = Duration::from_secs(1);
/// Longest wait for a scan, several times its period at 5 Hz.
const SCAN_TIMEOUT: Duration = Duration::from_secs(3);

struct Device {
    address: String,
    line: Line,
    encoding: Encoding,
    framer: Framer,
    received: usize,
    angles: DeviceAngles,
}

/// Probes the device at HOST or HOST:PORT; returns lines for the user, and a scan.
pub(super) fn probe(target: &str) -> anyhow::Result<(Vec<String>, Seen)> {
    let mut device = find(target)?;
    let mut said = vec![format!(
        "{}: answers {}",
        device.address,
        match device.encoding {
            Encoding::Binary => "CoLa B (--protocol cola-b)",
            Encoding::Text => "CoLa A (--protocol cola-a)",
        }
    )];
    for variable in [
        Variable::DeviceIdent,
        Variable::DeviceState,
        Variable::ScanConfig,
        Variable::OutputRange,
        Variable::ScanDataConfig,
    ] {
        said.push(device.describe(variable)?);
    }
    let (about, seen) = device.scan()?;
    said.extend(about);
    Ok((said, seen))
}

/// Returns the options of `lms_reader` for the device at HOST or HOST:PORT.
pub(super) fn reader_options(target: &str) -> anyhow::Result<Vec<String>> {
    let device = find(target)?;
    Ok(reader_options_of(&device.address, device.encoding))
}

pub(super) fn reader_options_of(address: &str, encoding: Encoding) -> Vec<String> {
    let protocol = match encoding {
        Encoding::Binary => "cola-b",
        Encoding::Text => "cola-a",
    };
    let words = ["--tcp", address, "--protocol", protocol];
    words.map(str::to_owned).to_vec()
}

/// Connects to the device: tries each port in each encoding.
fn find(target: &str) -> anyhow::Result<Device> {
    let addresses = addresses(target);
    let mut failure = None;
    let mut received = 0;
    let mut reached = None;
    for address in &addresses {
        for encoding in [Encoding::Binary, Encoding::Text] {
            let mut device = match Line::connect(address) {
                Ok(line) => Device {
                    address: address.clone(),
                    line,
                    encoding,
                    framer: Framer::new(encoding),
                    received: 0,
                    angles: DeviceAngles::Unnamed,
                },
                Err(error) => {
                    failure = Some((address, error));
                    break;
                }
            };
            reached = Some(address);
            if device.ask_answers() {
                return Ok(device);
            }
            received += device.received;
        }
    }
    match (reached, failure) {
        (None, Some((address, error))) => Err(error).with_context(|| not_reached(address)),
        (reached, _) => {
            let address = reached.map_or(target, String::as_str);
            Err(not_understood(&address, received, "CoLa B and CoLa A"))
        }
    }
}

/// Returns the address with its port, or with each usual port.
pub(super) fn addresses(target: &str) -> Vec<String> {
    let bare = target.parse::<Ipv6Addr>().map(|ip| format!("[{ip}]"));
    let host = bare.as_deref().unwrap_or(target);
    let port = host.rsplit_once(':').map(|(_, port)| port.parse::<u16>());
    match port {
        Some(Ok(_)) => vec![host.to_owned()],
        _ => PORTS.map(|port| format!("{host}:{port}")).into(),
    }
}

impl Device {
    /// Returns true if it answers; a device with the other encoding may close the connection.
    fn ask_answers(&mut self) -> bool {
        let outcome = self.ask(Command::Read(Variable::DeviceIdent), TIMEOUT, |telegram| {
            matches!(telegram, Telegram::Answer(_) | Telegram::ScanData(_)).then_some(())
        });
        outcome.is_ok_and(|answer| answer.is_some())
    }

    /// Sends a command and waits for the first telegram accepted by `pick`.
    fn ask<R>(
        &mut self,
        command: Command<'_>,
        patience: Duration,
        mut pick: impl FnMut(&Telegram<'_>) -> Option<R>,
    ) -> anyhow::Result<Option<R>> {
        let mut bytes = Vec::new();
        self.encoding.frame(&Telegram::Command(command), &mut bytes);
        let (framer, received) = (&mut self.framer, &mut self.received);
        let found = self.line.ask(&bytes, patience, |piece| {
            *received += piece.len();
            framer.push(piece);
            while let Some(next) = framer.next_frame() {
                if let Some(found) = next.ok().and_then(|frame| pick(&frame.telegram)) {
                    return Some(found);
                }
            }
            None
        });
        found.with_context(|| not_reached(&self.address))
    }

    /// Describes a variable, or the reason why the device does not return it.
    fn describe(&mut self, variable: Variable) -> anyhow::Result<String> {
        let command = Command::Read(variable);
        let mut angles = None;
        let found = self.ask(command, TIMEOUT, |telegram| match telegram {
            Telegram::Answer(Answer::Value(value)) if value.variable() == variable => {
                if let Value::DeviceIdent { name, .. } = value {
                    angles = Some(DeviceAngles::of_name(name));
                }
                Some(in_words(value))
            }
            Telegram::Answer(Answer::Fault(fault)) => {
                Some(format!("{variable:?}: rejected by the device: {fault}"))
            }
            _ => None,
        })?;
        if let Some(angles) = angles {
            self.angles = angles;
        }
        Ok(found.unwrap_or_else(|| format!("{variable:?}: no answer")))
    }

    /// Gets one scan, described in words and for drawing.
    fn scan(&mut self) -> anyhow::Result<(Vec<String>, Seen)> {
        let angles = std::mem::take(&mut self.angles);
        let found = self.ask(Command::SubscribeScans(true), SCAN_TIMEOUT, |telegram| {
            let Telegram::ScanData(scan) = telegram else {
                return None;
            };
            let channel = scan.channels_16_bit.named(b"DIST1")?;
            let (looks, convention, up) = in_which_way(&angles, Field::of(&channel));
            let (count, seen) = (channel.values.len(), seen(&channel, convention, up));
            let returns = seen.points.len();
            let about = format!("a scan of {count} readings, {returns} with a return");
            Some((vec![looks, about], seen))
        })?;
        self.ask(Command::SubscribeScans(false), TIMEOUT, |telegram| {
            matches!(telegram, Telegram::Answer(_)).then_some(())
        })?;
        let none = "no scan received: is the device measuring?".to_owned();
        Ok(found.unwrap_or_else(|| (vec![none], Seen::default())))
    }
}

/// Describes how `lms_reader` reads the angles, and the way that is up in the picture.
fn in_which_way(angles: &DeviceAngles, field: Field) -> (String, AngleConvention, String) {
    match angles.convention(field) {
        Ok(convention) => {
            let looks = format!("looks       {convention} ({})", angles.reason());
            (looks, convention, "ahead is up".to_owned())
        }
        Err(error) => {
            let usual = AngleConvention::USUAL;
            let up = format!("the device's {}° is up", usual.ahead_deg);
            (format!("looks       {error}"), usual, up)
        }
    }
}

fn seen(channel: &Channel<'_>, convention: AngleConvention, up: String) -> Seen {
    let points = channel
        .distances_m()
        .enumerate()
        .filter_map(|(beam, metres)| {
            let step_deg = f64::from(channel.step_raw_1e4_deg) * 1e-4;
            let deg = f64::from(channel.start_angle_raw_1e4_deg) * 1e-4 + beam as f64 * step_deg;
            Some((convention.bearing_deg(deg).to_radians(), metres?))
        });
    Seen {
        points: points.collect(),
        up,
    }
}

fn in_words(value: &Value<'_>) -> String {
    let angles = |range: &OutputRange| {
        format!(
            "every {}°, from {}° to {}°",
            f64::from(range.resolution_raw_1e4_deg) * 1e-4,
            f64::from(range.start_angle_raw_1e4_deg) * 1e-4,
            f64::from(range.stop_angle_raw_1e4_deg) * 1e-4
        )
    };
    match value {
        Value::DeviceIdent { name, version } => {
            let (name, version) = (name.escape_ascii(), version.escape_ascii());
            format!("device      {name}, version {version}")
        }
        Value::DeviceState(state) => format!("state       {}", state_word(*state)),
        Value::ScanConfig(config) => format!(
            "measures    {} Hz, {}",
            f64::from(config.frequency_raw_1e2_hz) * 1e-2,
            angles(&config.range)
        ),
        Value::OutputRange(range) => format!("sends       {}", angles(range)),
        Value::ScanDataConfig(config) => format!(
            "contents    every scan in {}; remission {}, name {}, time {}",
            config.interval,
            yes(config.remission),
            yes(config.name),
            yes(config.time)
        ),
        Value::HostEncoding(binary) => {
            format!("encoding    CoLa {}", if *binary { "B" } else { "A" })
        }
    }
}

fn yes(is: bool) -> &'static str {
    if is { "yes" } else { "no" }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_host_alone_has_two_ports() {
        let both = ["192.168.0.1:2112", "192.168.0.1:2111"];
        assert_eq!(addresses("192.168.0.1"), both);
        assert_eq!(addresses("laser:2111"), ["laser:2111"]);
        assert_eq!(addresses("fe80::1"), ["[fe80::1]:2112", "[fe80::1]:2111"]);
        assert_eq!(addresses("[fe80::1]:7"), ["[fe80::1]:7"]);
    }

    #[test]
    fn what_is_to_be_stated_is_reported() {
        let around_zero = Field {
            first_deg: -120.0,
            last_deg: 120.0,
        };
        let (looks, _, up) = in_which_way(&DeviceAngles::of_name(b"XY7"), around_zero);
        let asks = looks.contains("--device NAME") && looks.contains("--zero-deg");
        assert!(asks, "{looks}");
        assert_eq!(up, "the device's 90° is up");
        let (looks, convention, up) = in_which_way(&DeviceAngles::of_name(b"TiM240"), around_zero);
        let is_known = looks.contains("0° is ahead") && looks.contains("TiM2xx");
        assert!(is_known, "{looks}");
        assert_eq!((convention.ahead_deg, up.as_str()), (0.0, "ahead is up"));
    }
}
