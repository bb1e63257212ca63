//! Errors of the network session.

use std::path::PathBuf;

use transport::TransportError;

/// Error of Zenoh.
pub type Cause = Box<dyn std::error::Error + Send + Sync>;

/// A key cannot be used.
#[derive(Debug, thiserror::Error)]
#[error("cannot {action} {key}")]
pub struct KeyError {
    /// Verb of what was tried.
    pub action: &'static str,
    pub key: String,
    pub source: Cause,
}

impl KeyError {
    /// Returns a function that converts an error of Zenoh.
    pub fn when(action: &'static str, key: &str) -> impl FnOnce(Cause) -> Self {
        move |source| KeyError {
            action,
            key: key.to_owned(),
            source,
        }
    }
}

/// Error of opening a session.
#[derive(Debug, thiserror::Error)]
pub enum NetworkError {
    /// Zenoh's configuration file cannot be used.
    #[error("cannot use {}", file.display())]
    ConfigFile {
        file: PathBuf,
        /// Error of Zenoh or of reading the file.
        source: Cause,
    },
    /// The configuration file has an unknown extension.
    #[error("{} is not a configuration file: allowed are files in JSON5 that end in .json5 or .json", file.display())]
    Format {
        /// Path as given.
        file: PathBuf,
    },
    /// An option is invalid in Zenoh's configuration.
    #[error("{value} is nothing for {key} of Zenoh's configuration")]
    Setting {
        /// Key in the configuration.
        key: &'static str,
        value: String,
        source: Cause,
    },
    #[error("cannot open the Zenoh session")]
    Session(#[source] Cause),
    /// The graph failed in the meantime.
    #[error(transparent)]
    Transport(#[from] TransportError),
}
