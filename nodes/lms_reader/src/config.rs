//! Command-line options.

use std::path::PathBuf;

use clap::{ArgAction, ArgGroup, Parser, ValueEnum};
use command_line::number;
use geometry::Mount;
use messages::{FrameName, Name};
use sick::cola::{AngleConvention, DeviceAngles, Encoding, KnownDevice, USUAL_REACH_M};
use sick::lms2xx::{Baud, RangeMode, Unit};

use crate::scan::{ScanSettings, Stamps};

/// Reads scans from a SICK laser scanner and publishes them as `scan`.
#[derive(Debug, Clone, Parser)]
#[command(name = "lms_reader", version)]
#[command(group(ArgGroup::new("source").required(true).args(["tcp", "serial", "capture"])))]
pub struct Config {
    /// Address of the device, HOST:PORT; devices listen on port 2112 or 2111. The host `graph` is
    /// the emulator of this graph.
    #[arg(long, value_name = "HOST:PORT", value_parser = address)]
    pub tcp: Option<String>,

    /// Serial port of an LMS200, 211, 220, 221 or 291, such as /dev/ttyUSB0.
    #[arg(long, value_name = "DEVICE")]
    pub serial: Option<PathBuf>,

    /// Encoding of --tcp and --capture, as set on the device.
    #[arg(long, value_enum, default_value_t = Encoding::Binary, conflicts_with = "serial")]
    pub protocol: Encoding,

    /// Baud rate to switch the serial device to: 9600, 19200, 38400 or 500000 [default: the rate at
    /// which it answers].
    #[arg(long, value_name = "RATE", conflicts_with_all = ["tcp", "capture"])]
    pub baud: Option<Baud>,

    /// Field of view, degrees, half of it to each side: 100 or 180 with --serial, else
    /// up to 360 [default: the device's setting].
    #[arg(long, value_name = "DEGREES", value_parser = number(1.0..=360.0, "degrees"), conflicts_with = "capture")]
    pub field: Option<f64>,

    /// Angle between beams, degrees: 0.25, 0.5 or 1 with --serial, else any value that the device
    /// supports [default: the device's setting].
    #[arg(long, value_name = "DEGREES", value_parser = number(0.01..=5.0, "degrees"), conflicts_with = "capture")]
    pub resolution: Option<f64>,

    /// Range of the serial device, metres: 8, 16 or 32 in millimetres, 80 in centimetres [default:
    /// the device's setting]. It is written to the device's memory, which lasts for some 10,000
    /// writes.
    #[arg(long, value_name = "METRES", value_parser = range, conflicts_with_all = ["tcp", "capture"])]
    pub range: Option<Reach>,

    /// Capture file to read instead of a device: CoLa telegrams back to back. At its end the node
    /// waits up to 30 seconds for subscribers to read the last scans.
    #[arg(long, value_name = "FILE")]
    pub capture: Option<PathBuf>,

    /// Repeat the capture without end.
    #[arg(long = "loop", conflicts_with_all = ["tcp", "serial"])]
    pub looped: bool,

    /// Playback speed of the capture.
    #[arg(long, value_enum, default_value_t = Rate::Device, conflicts_with_all = ["tcp", "serial"])]
    pub rate: Rate,

    /// Send commands to a device on the network: identify it, configure it and start the scans
    /// (`sEN LMDscandata 1`). If false, the node only receives.
    #[arg(long, value_name = "BOOL", default_value_t = true, action = ArgAction::Set)]
    pub start_stream: bool,

    /// Clock that stamps the scans of --tcp or --capture.
    #[arg(long, value_enum, default_value_t = Stamps::Host, conflicts_with = "serial")]
    pub stamps: Stamps,

    /// Exit when the device closes the connection after it has sent scans, instead of reconnecting:
    /// for devices that play a recording.
    #[arg(long, conflicts_with_all = ["serial", "capture"])]
    pub until_closed: bool,

    /// Timeout in seconds, 0.2 to 3600: the connection is closed if no byte (--tcp) or telegram
    /// (--serial) is received for this long.
    #[arg(long, value_name = "SECONDS", default_value_t = 5.0, value_parser = number(0.2..=3600.0, "seconds"))]
    pub silence: f64,

    /// Pose of the laser on the robot: metres ahead, metres to the left, degrees counter-clockwise,
    /// and 180 if it hangs upside down [default: unknown].
    #[arg(long, value_name = "X,Y,YAW_DEG[,180]", allow_hyphen_values = true)]
    pub mount: Option<Mount>,

    /// The laser hangs upside down: rolled by 180° about its x axis.
    #[arg(long)]
    pub upside_down: bool,

    /// Frame of the laser, 1 to 256 bytes.
    #[arg(long, value_name = "NAME", default_value = "laser", value_parser = frame)]
    pub frame: FrameName,

    /// Name of this laser among several in the graph, at most 32 bytes; the accumulator's --scans
    /// refers to it.
    #[arg(long, value_name = "NAME", default_value = "", value_parser = laser)]
    pub laser: Name,

    /// Shortest valid range, metres, from 0; shorter readings are no returns.
    #[arg(long, value_name = "METRES", default_value_t = 0.05, value_parser = metres)]
    pub range_min_m: f32,

    /// Longest valid range, metres, above --range-min-m; readings from here on are no returns
    /// [default: 80, or the range of the known device if that is longer].
    #[arg(long, value_name = "METRES", value_parser = metres)]
    pub range_max_m: Option<f32>,

    /// Name of the device of --tcp or --capture, such as TiM240 or NAV310, which defines the angle
    /// that points ahead and the direction of the angles [default: the name that the device
    /// reports].
    #[arg(long, value_name = "NAME", value_parser = device, conflicts_with = "serial")]
    pub device: Option<&'static KnownDevice>,

    /// Device angle that points ahead, degrees: 90 on most devices. With --tcp or --capture,
    /// instead of --device.
    #[arg(long, value_name = "DEGREES", value_parser = number(-360.0..=360.0, "degrees"), allow_hyphen_values = true, conflicts_with_all = ["serial", "device"])]
    pub zero_deg: Option<f64>,

    /// The device's own angles grow clockwise, seen from above.
    #[arg(long, requires = "zero_deg")]
    pub clockwise: bool,
}

/// Longest range of an LMS2xx and the unit of its distances.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Reach {
    /// Measuring mode, which defines the bits of a distance.
    pub mode: RangeMode,
    pub unit: Unit,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Rate {
    /// At the device's own pace, by its time stamps.
    Device,
    /// As fast as it can be read: a slower subscriber receives only the newest scans.
    Max,
}

impl Config {
    pub fn from_command_line() -> Self {
        command_line::parse(Config::check)
    }

    /// Checks rules that concern more than one option.
    fn check(&self) -> Result<(), String> {
        self.check_serial()?;
        let range_max_m = self.range_max_m.unwrap_or(USUAL_REACH_M);
        if self.range_min_m < range_max_m {
            return Ok(());
        }
        Err(format!(
            "--range-max-m is {range_max_m} and --range-min-m {}: the maximum must be larger",
            self.range_min_m
        ))
    }

    /// Checks that an LMS2xx supports this field and resolution.
    fn check_serial(&self) -> Result<(), String> {
        if self.serial.is_none() {
            return Ok(());
        }
        if !self.start_stream {
            return Err("--start-stream false: a serial device must be asked what it sends".into());
        }
        match (self.field, self.resolution) {
            (None | Some(100.0 | 180.0), None | Some(0.5 | 1.0))
            | (None | Some(100.0), Some(0.25)) => Ok(()),
            (field, resolution) => Err(format!(
                "--field {} and --resolution {}: with --serial allowed are 100 or 180 at 0.5 or 1, \
                 and 100 at 0.25",
                field.unwrap_or(180.0),
                resolution.unwrap_or(0.5)
            )),
        }
    }

    /// Returns the message fields that are not in the telegrams.
    pub fn scan_settings(&self) -> ScanSettings {
        ScanSettings {
            range_min_m: self.range_min_m,
            range_max_m: self.range_max_m,
            base_from_laser: self.mount.map(|mount| mount.base_from_laser.into()),
            upside_down: self.upside_down || self.mount.is_some_and(|m| m.is_upside_down),
            laser: self.laser,
            frame: self.frame,
            stamps: self.stamps,
        }
    }

    /// Returns the angle convention stated by the options, if any.
    pub fn stated_angles(&self) -> Option<DeviceAngles> {
        let stated = self.zero_deg.map(|ahead_deg| {
            DeviceAngles::Stated(AngleConvention {
                ahead_deg,
                clockwise: self.clockwise,
            })
        });
        stated.or(self.device.map(DeviceAngles::Known))
    }
}

fn device(text: &str) -> Result<&'static KnownDevice, String> {
    let found = KnownDevice::named(text);
    let row = found.ok_or_else(|| {
        format!(
            "known are {}; for another one state --zero-deg, and --clockwise if need be",
            KnownDevice::names()
        )
    })?;
    match row.convention {
        Some(_) => Ok(row),
        None => Err(format!(
            "which of its angles points ahead is not known, the sources differ ({}): state \
             --zero-deg, and --clockwise if need be",
            row.source
        )),
    }
}

fn address(text: &str) -> Result<String, String> {
    let port = text
        .rsplit_once(':')
        .map(|(host, port)| (host, port.parse()));
    match port {
        Some((host, Ok(1u16..))) if !host.is_empty() => Ok(text.into()),
        _ => Err("expected is HOST:PORT with a port from 1 to 65535".into()),
    }
}

fn range(text: &str) -> Result<Reach, String> {
    let (mode, unit) = match text {
        "8" => (RangeMode::Range8Fields, Unit::Millimetre),
        "16" => (RangeMode::Range16Fields, Unit::Millimetre),
        "32" => (RangeMode::Range32Field, Unit::Millimetre),
        "80" => (RangeMode::Range8Fields, Unit::Centimetre),
        _ => return Err("allowed are 8, 16, 32 and 80".into()),
    };
    Ok(Reach { mode, unit })
}

fn metres(text: &str) -> Result<f32, String> {
    match text.parse::<f32>() {
        Ok(metres) if metres >= 0.0 && metres.is_finite() => Ok(metres),
        _ => Err("allowed are finite numbers of metres from 0".into()),
    }
}

fn frame(text: &str) -> Result<FrameName, String> {
    if (1..=FrameName::CAPACITY).contains(&text.len()) {
        return Ok(FrameName::new(text));
    }
    Err(format!(
        "it has {} bytes, allowed are 1 to {}",
        text.len(),
        FrameName::CAPACITY
    ))
}

fn laser(text: &str) -> Result<Name, String> {
    match text.len() {
        0..=Name::CAPACITY => Ok(Name::new(text)),
        length => Err(format!(
            "it has {length} bytes, allowed are at most {}",
            Name::CAPACITY
        )),
    }
}

#[cfg(test)]
mod tests;
