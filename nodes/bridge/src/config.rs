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
    #[arg(long, value_name = "NAME", value_parser = network_payload::robot,
          default_value_t = network_payload::robot_of_host(), hide_default_value = true)]
    pub robot: String,

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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_robot_has_a_name_that_can_stand_in_keys() {
        let error = Config::try_parse_from(["bridge", "--robot", "a/b"]).unwrap_err();
        let text = error.to_string();
        assert!(text.contains("1 to 64 of a-z A-Z 0-9 - _ ."), "{text}");
    }
}
