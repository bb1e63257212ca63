//! Errors of serving the page.

use std::io;
use std::net::SocketAddr;
use std::path::PathBuf;

/// What was tried, what was found and what is allowed.
#[derive(Debug, thiserror::Error)]
pub enum DashboardError {
    /// It cannot listen there.
    #[error("cannot listen on {address}, nor on the {tried} ports after it")]
    Listen {
        /// Where.
        address: SocketAddr,
        /// Ports that were tried beyond.
        tried: u16,
        /// What the system says.
        source: io::Error,
    },
    /// The thread of the server cannot be started.
    #[error("cannot start the server")]
    Server(#[source] io::Error),
    /// The token cannot be read.
    #[error("cannot read the token in {}", path.display())]
    TokenFile {
        /// The file.
        path: PathBuf,
        /// What the system says.
        source: io::Error,
    },
    /// Everybody on the machine can read the token, or replace it.
    #[error("{} has mode {mode:o}, so that everybody on this machine knows the token: chmod 600, or 640 for a group, is needed", path.display())]
    OpenTokenFile {
        /// The file.
        path: PathBuf,
        /// Its rights.
        mode: u32,
    },
    /// The token could be guessed, or cannot be sent.
    #[error("the token in {} has {found} characters; needed are 16 to 256 of ASCII without spaces", path.display())]
    Token {
        /// The file.
        path: PathBuf,
        /// Characters that it has.
        found: usize,
    },
    /// The system gives no random numbers.
    #[error("the system gives no random numbers for a token: {0}")]
    Random(getrandom::Error),
}
