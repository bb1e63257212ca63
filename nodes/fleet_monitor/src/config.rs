//! Command-line options.

use std::net::SocketAddr;

use clap::Parser;

/// Serves a web page to watch all robots with a reachable bridge, and an API with the same content.
///
/// Serves this machine only, unless --page says otherwise. If the port is taken, it uses the next
/// free one and logs which.
#[derive(Debug, Clone, Parser)]
#[command(name = "fleet_monitor", version)]
pub struct Config {
    /// Address of the page; port 0 is any free port. On an address reachable from other machines,
    /// anyone who can reach the port can read, and nothing is encrypted
    #[arg(long, value_name = "ADDRESS:PORT", default_value = "127.0.0.1:7440")]
    pub page: SocketAddr,

    #[command(flatten)]
    pub dashboard: dashboard::Options,

    #[command(flatten)]
    pub network: zenoh_session::Options,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_this_machine_is_served_unless_asked_for() {
        let config = Config::try_parse_from(["fleet_monitor"]).unwrap();
        assert!(config.page.ip().is_loopback());
    }
}
