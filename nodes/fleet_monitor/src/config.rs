//! Command-line options.

use std::net::SocketAddr;

use clap::Parser;

/// Serves a web page to watch all robots whose bridges are reached, and an API with
/// the same content.
///
/// The page is served to this machine alone unless --page says otherwise. Where the
/// port is taken, it takes the next free one and says which.
#[derive(Debug, Clone, Parser)]
#[command(name = "fleet_monitor", version)]
pub struct Config {
    /// Address of the page; port 0 is any free port. Beyond this machine whoever
    /// reaches the port can read, and nothing is encrypted
    #[arg(long, value_name = "ADDRESS:PORT", default_value = "127.0.0.1:7440")]
    pub page: SocketAddr,

    /// Who may reach the page.
    #[command(flatten)]
    pub dashboard: dashboard::Options,

    /// How it joins the network.
    #[command(flatten)]
    pub network: zenoh_session::Options,
}

#[cfg(test)]
mod tests {
    use clap::CommandFactory;

    use super::*;

    #[test]
    fn only_this_machine_is_served_unless_asked_for() {
        Config::command().debug_assert();
        let config = Config::try_parse_from(["fleet_monitor"]).unwrap();
        assert!(config.page.ip().is_loopback());
    }
}
