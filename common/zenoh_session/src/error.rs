//! Errors of opening a session.

use std::path::PathBuf;

use transport::TransportError;

/// What Zenoh says.
pub type Cause = Box<dyn std::error::Error + Send + Sync>;

/// A key cannot be used.
#[derive(Debug, thiserror::Error)]
#[error("cannot {action} {key}")]
pub struct KeyError {
    /// What was tried.
    pub action: &'static str,
    /// The key.
    pub key: String,
    /// What Zenoh says.
    pub source: Cause,
}

impl KeyError {
    /// Makes one of what Zenoh says.
    pub fn when(action: &'static str, key: &str) -> impl FnOnce(Cause) -> Self {
        move |source| KeyError {
            action,
            key: key.to_owned(),
            source,
        }
    }
}

/// What was tried, what was found and what is allowed.
#[derive(Debug, thiserror::Error)]
pub enum NetworkError {
    /// Zenoh's configuration cannot be used.
    #[error("cannot use {}", file.display())]
    ConfigFile {
        /// The file.
        file: PathBuf,
        /// What Zenoh says.
        source: Cause,
    },
    /// The file is invalid that Zenoh's configuration is read from.
    #[error("{} is not a configuration file: allowed are files in JSON5 that end in .json5 or .json", file.display())]
    Format {
        /// The file.
        file: PathBuf,
    },
    /// An option cannot be put into Zenoh's configuration.
    #[error("{value} is nothing for {key} of Zenoh's configuration")]
    Setting {
        /// The key of the configuration.
        key: &'static str,
        /// What was to stand there.
        value: String,
        /// What Zenoh says.
        source: Cause,
    },
    /// The session cannot be opened.
    #[error("cannot open the Zenoh session")]
    Session(#[source] Cause),
    /// The graph fails meanwhile.
    #[error(transparent)]
    Transport(#[from] TransportError),
}
