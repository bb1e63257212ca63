//! Command-line options.

use std::net::SocketAddr;

use clap::Parser;

/// Serves a web page to watch the graph, and an API with the same content.
///
/// Listens on this machine only, unless --listen says otherwise. If the port is taken, it uses the
/// next free one and logs which.
#[derive(Debug, Clone, Parser)]
#[command(name = "monitor", version)]
pub struct Config {
    /// Address to listen on; port 0 is any free port. On an address reachable from other machines,
    /// anyone who can reach the port can read, and nothing is encrypted
    #[arg(long, value_name = "ADDRESS:PORT", default_value = "127.0.0.1:7440")]
    pub listen: SocketAddr,

    /// Name of the robot [default: the name of the machine]
    #[arg(long, value_name = "NAME", value_parser = network_payload::robot)]
    pub robot: Option<String>,

    #[command(flatten)]
    pub page: dashboard::Options,
}

impl Config {
    pub fn robot(&self) -> String {
        let host = gethostname::gethostname();
        network_payload::robot_or_host(self.robot.as_deref(), &host.to_string_lossy())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parse(arguments: &str) -> Result<Config, String> {
        let words = ["monitor"].into_iter().chain(arguments.split_whitespace());
        Config::try_parse_from(words).map_err(|error| error.to_string())
    }

    #[test]
    fn only_this_machine_is_served_unless_asked_for() {
        let config = parse("").unwrap();
        assert!(config.listen.ip().is_loopback());
        assert!(!config.robot().is_empty());
        assert_eq!(parse("--robot r-7").unwrap().robot(), "r-7");
    }

    #[test]
    fn what_is_refused_says_what_is_allowed() {
        let refuse = |arguments: &str, expected: &str| {
            let text = parse(arguments).unwrap_err();
            assert!(text.contains(expected), "{arguments}: {text}");
        };
        refuse("--robot a/b", "allowed are 1 to 64");
        refuse("--host http://a", "name of a host");
        refuse("--listen 7440", "invalid socket address");
    }
}
