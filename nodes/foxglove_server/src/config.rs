//! Command-line options.

use std::net::SocketAddr;

use clap::Parser;

/// Shows a graph live in Foxglove and Lichtblick: open a connection of the kind "Foxglove
/// WebSocket" there, to the address in the log.
///
/// Listens on this machine only, unless --listen says otherwise. Viewers can only read.
#[derive(Debug, Clone, Parser)]
#[command(name = "foxglove_server", version)]
pub struct Config {
    /// Address to listen on; port 0 is any free port. On an address reachable from other machines,
    /// anyone who can reach the port can read, and nothing is encrypted
    #[arg(long, value_name = "ADDRESS:PORT", default_value = "127.0.0.1:8765")]
    pub listen: SocketAddr,

    /// Name of the robot [default: the name of the machine]
    #[arg(long, value_name = "NAME", value_parser = network_payload::robot,
          default_value_t = network_payload::robot_of_host(), hide_default_value = true)]
    pub robot: String,

    #[command(flatten)]
    pub transcript: ros_graph::export::Options,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_this_machine_is_served_unless_asked_for() {
        let config = Config::parse_from(["foxglove_server"]);
        assert!(config.listen.ip().is_loopback());
        assert!(!config.robot.is_empty());
    }
}
