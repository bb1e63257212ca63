//! Command-line options.

use std::path::PathBuf;

use clap::{ArgGroup, Parser};
use command_line::number;
use ros_graph::replay::Rate;
use sick::cola::{Encoding, KnownDevice};
use sick::lms2xx::Baud;

use crate::FaultPlan;

/// Plays a recording as a SICK laser scanner.
///
/// Playback starts when a client requests scans; the other messages of the recording go to
/// `odometry` and `ground_truth`. Without --loop the node exits at the end, once its clients have
/// read everything: with code 0, or 3 if a scan got no answer at --rate max or a message could not
/// be used.
#[derive(Debug, Clone, Parser)]
#[command(name = "emulator", version)]
#[command(group(ArgGroup::new("device").required(true).args(["listen", "pty"])))]
pub struct Config {
    /// Recording to play: an MCAP file with ROS 2 messages, or a bag of rosbag2 (its folder, or
    /// .db3).
    #[arg(long, value_name = "FILE")]
    pub recording: PathBuf,

    /// Topic of the scans [default: the only one, or /scan]
    #[arg(long, value_name = "TOPIC")]
    pub scan_topic: Option<String>,

    /// Topic of the odometry [default: the only one, or /odom]
    #[arg(long, value_name = "TOPIC")]
    pub odom_topic: Option<String>,

    /// Emulate an LMS1xx, LMS5xx or TiM on this socket: tcp://HOST:PORT. The host `graph` is an
    /// address on this machine that no other graph has.
    #[arg(long, value_name = "ADDRESS", value_parser = listen)]
    pub listen: Option<String>,

    /// Encoding of --listen.
    #[arg(long, value_enum, default_value_t = Encoding::Binary, conflicts_with = "pty")]
    pub protocol: Encoding,

    /// Device type for --listen, such as TiM240 or NAV310, which defines how angles are counted
    /// [default: LMS111].
    #[arg(long = "device", value_name = "NAME", value_parser = model, conflicts_with = "pty")]
    pub model: Option<&'static KnownDevice>,

    /// Emulate an LMS2xx on a pseudo-terminal with this symbolic link to it.
    #[arg(long, value_name = "LINK")]
    pub pty: Option<PathBuf>,

    /// Baud rate of the LMS2xx after power-on: 9600, 19200, 38400 or 500000. At any other rate it
    /// receives and sends garbage.
    #[arg(long, value_name = "RATE", default_value = "9600")]
    pub baud: Baud,

    /// Playback speed as a multiple of the original, 0.001 to 1000; or max: each scan is sent after
    /// the answer to the previous one on `hypotheses`.
    #[arg(long, value_name = "FACTOR|max", default_value_t = Rate::Factor(1.0))]
    pub rate: Rate,

    /// Repeat the recording without end.
    #[arg(long = "loop")]
    pub looped: bool,

    /// Faults, separated by commas: crc=P, drop=P and garbage=P damage, omit and precede telegrams
    /// with this probability; stall=DURATION is silent for this time after one telegram in a
    /// hundred; reset=DURATION restarts the device at this interval; split and merge cut telegrams
    /// into pieces and send several at once. CoLa A has no checksum, so its readers do not notice
    /// crc.
    #[arg(long, value_name = "FAULTS", default_value = "")]
    pub fault: FaultPlan,

    /// Nodes that must be ready before playback starts, separated by commas.
    #[arg(long, value_name = "NODES", value_delimiter = ',')]
    pub wait_for: Vec<String>,

    /// Timeout for an answer at --rate max, seconds, 0.1 to 3600.
    #[arg(long, value_name = "SECONDS", default_value_t = 30.0, value_parser = number(0.1..=3600.0, "seconds"))]
    pub patience: f64,

    /// Seed of the random faults.
    #[arg(long, value_name = "NUMBER", default_value_t = 1)]
    pub seed: u64,
}

fn model(text: &str) -> Result<&'static KnownDevice, String> {
    let found = KnownDevice::named(text).filter(|row| row.convention.is_some());
    found.ok_or_else(|| format!("known are {}", KnownDevice::names()))
}

fn listen(text: &str) -> Result<String, String> {
    let address = text.strip_prefix("tcp://");
    let port = address.and_then(|address| address.rsplit_once(':'));
    match (
        address,
        port.map(|(host, port)| (host, port.parse::<u16>())),
    ) {
        (Some(address), Some((host, Ok(_)))) if !host.is_empty() => Ok(address.into()),
        _ => Err("expected is tcp://HOST:PORT with a port from 0 to 65535".into()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_refused_says_what_is_allowed() {
        for (arguments, expected) in [
            ("", "--listen"),
            ("--listen tcp://a:1 --device XY7", "known are LMS1xx"),
            ("--listen 127.0.0.1:2112", "tcp://HOST:PORT"),
            ("--listen tcp://a:x", "0 to 65535"),
            ("--pty b --baud 1", "38400 and 500000"),
            ("--pty b --rate 0", "0.001 to 1000, and max"),
            ("--pty b --patience 0", "0.1 to 3600 seconds"),
            ("--pty b --fault crc=2", "0 to 1"),
        ] {
            let arguments = format!("emulator --recording a {arguments}");
            let outcome = Config::try_parse_from(arguments.split_whitespace());
            let text = outcome.unwrap_err().to_string();
            assert!(text.contains(expected), "{arguments}: {text}");
        }
    }
}
