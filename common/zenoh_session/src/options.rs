//! Command-line options.

use std::path::PathBuf;

#[derive(Debug, Clone, Default, clap::Args)]
#[command(next_help_heading = "Network")]
pub struct Options {
    /// Zenoh configuration file, JSON5: routers, users, access control
    #[arg(long, value_name = "FILE")]
    pub config: Option<PathBuf>,

    /// Address to listen on, e.g. tcp/0.0.0.0:7447. May be repeated [default: tcp/127.0.0.1:7447,
    /// and none with --connect]
    #[arg(long, value_name = "ENDPOINT")]
    pub listen: Vec<String>,

    /// Address to connect to, e.g. tcp/192.168.0.7:7447; retried until it is reachable. May be
    /// repeated
    #[arg(long, value_name = "ENDPOINT")]
    pub connect: Vec<String>,
}
