//! What a user can set of it.

use std::path::PathBuf;

/// How a node joins the network.
#[derive(Debug, Clone, Default, clap::Args)]
#[command(next_help_heading = "Network")]
pub struct Options {
    /// Zenoh's own configuration, JSON5: routers, users, access control
    #[arg(long, value_name = "FILE")]
    pub config: Option<PathBuf>,

    /// Where to listen, as tcp/0.0.0.0:7447. May be given again [default:
    /// tcp/127.0.0.1:7447, and nowhere with --connect]
    #[arg(long, value_name = "ENDPOINT")]
    pub listen: Vec<String>,

    /// Whom to connect to, as tcp/192.168.0.7:7447; tried until it is there. May
    /// be given again
    #[arg(long, value_name = "ENDPOINT")]
    pub connect: Vec<String>,
}
