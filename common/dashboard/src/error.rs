//! Errors of the web server.

use std::io;
use std::net::SocketAddr;
use std::path::PathBuf;

#[derive(Debug, thiserror::Error)]
pub enum DashboardError {
    #[error("cannot listen on {address}, nor on the {tried} ports after it")]
    Listen {
        address: SocketAddr,
        tried: u16,
        source: io::Error,
    },
    #[error("cannot start the server")]
    Server(#[source] io::Error),
    #[error("cannot read the token in {}", path.display())]
    TokenFile { path: PathBuf, source: io::Error },
    /// Every user of the machine can read or replace the token.
    #[error("{} has mode {mode:o}, so that everybody on this machine knows the token: chmod 600, or 640 for a group, is needed", path.display())]
    OpenTokenFile { path: PathBuf, mode: u32 },
    /// The token is too short, too long or has characters that an HTTP header cannot carry.
    #[error("the token in {} has {found} characters; needed are 16 to 256 of ASCII without spaces", path.display())]
    Token { path: PathBuf, found: usize },
    #[error("the system gives no random numbers for a token: {0}")]
    Random(getrandom::Error),
}
