//! Command-line options.

use std::path::PathBuf;

use clap::Parser;

use crate::Rate;

/// Connects graphs on several machines over Zenoh.
///
/// Listens on this machine only by default. The descriptor defines the topics: inputs of the bridge
/// are sent, its outputs are received.
#[derive(Debug, Clone, Parser)]
#[command(name = "bridge", version)]
pub struct Config {
    /// Name of the robot, a part of every key. It must be the same for all bridges of one robot
    /// [default: the name of the machine]
    #[arg(long, value_name = "NAME", value_parser = network_payload::robot)]
    pub robot: Option<String>,

    /// Descriptor that defines which topics are sent and received
    #[arg(long, value_name = "FILE", default_value = "dataflow.yaml")]
    pub dataflow: PathBuf,

    /// Id of this bridge in the descriptor
    #[arg(long, value_name = "ID", default_value = "bridge")]
    pub id: String,

    /// Maximum number of messages per second sent on a live topic, 0.001 to 10000, as
    /// field=2. May be repeated [default: field=2, no limit for the others]
    #[arg(long, value_name = "TOPIC=HZ")]
    pub rate: Vec<Rate>,

    #[command(flatten)]
    pub memory: map::MemoryOptions,

    #[command(flatten)]
    pub network: zenoh_session::Options,
}

impl Config {
    /// Returns the name of the robot.
    pub fn robot(&self) -> String {
        let host = gethostname::gethostname();
        network_payload::robot_or_host(self.robot.as_deref(), &host.to_string_lossy())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parse(arguments: &[&str]) -> Result<Config, String> {
        let all = ["bridge"].iter().chain(arguments);
        Config::try_parse_from(all).map_err(|error| error.to_string())
    }

    #[test]
    fn what_is_refused_says_what_is_allowed() {
        let error = parse(&["--robot", "a/b"]).unwrap_err();
        assert!(error.contains("1 to 64 of a-z A-Z 0-9 - _ ."), "{error}");
        let error = parse(&["--rate", "scam=1"]).unwrap_err();
        assert!(error.contains("scan, odometry"), "{error}");
    }

    #[test]
    fn the_robot_has_a_name_that_can_stand_in_keys() {
        assert_eq!(parse(&["--robot", "r2"]).unwrap().robot(), "r2");
        assert!(network_payload::robot(&parse(&[]).unwrap().robot()).is_ok());
    }
}
