//! Command-line options.

use std::net::SocketAddr;

use clap::Parser;

/// Shows a graph live to Foxglove and Lichtblick: there, open a connection of the
/// kind "Foxglove WebSocket" to the address that the log says.
///
/// Listens on this machine alone unless --listen says otherwise. Viewers can read,
/// and nothing else.
#[derive(Debug, Clone, Parser)]
#[command(name = "foxglove_server", version)]
pub struct Config {
    /// Address to listen on; port 0 is any free port. Beyond this machine whoever
    /// reaches the port can read, and nothing is encrypted
    #[arg(long, value_name = "ADDRESS:PORT", default_value = "127.0.0.1:8765")]
    pub listen: SocketAddr,

    /// The robot's name [default: the name of the machine]
    #[arg(long, value_name = "NAME", value_parser = network_payload::robot)]
    pub robot: Option<String>,

    /// How frames are called.
    #[command(flatten)]
    pub transcript: ros_export::Options,
}

impl Config {
    /// The robot's name.
    #[must_use]
    pub fn robot(&self) -> String {
        let host = gethostname::gethostname();
        network_payload::robot_or_host(self.robot.as_deref(), &host.to_string_lossy())
    }
}

#[cfg(test)]
mod tests {
    use clap::CommandFactory;

    use super::*;

    #[test]
    fn only_this_machine_is_served_unless_asked_for() {
        Config::command().debug_assert();
        let config = Config::parse_from(["foxglove_server"]);
        assert!(config.listen.ip().is_loopback());
        assert!(!config.robot().is_empty());
    }
}
