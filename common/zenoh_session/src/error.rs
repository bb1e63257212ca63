//! Errors of the network session.

use std::path::PathBuf;

use transport::TransportError;

pub type Cause = Box<dyn std::error::Error + Send + Sync>;

#[derive(Debug, thiserror::Error)]
#[error("cannot {action} {key}")]
pub struct KeyError {
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

#[derive(Debug, thiserror::Error)]
pub enum NetworkError {
    #[error("cannot use {}", file.display())]
    ConfigFile { file: PathBuf, source: Cause },
    #[error("{} is not a configuration file: allowed are files in JSON5 that end in .json5 or .json", file.display())]
    Format { file: PathBuf },
    #[error("{value} is nothing for {key} of Zenoh's configuration")]
    Setting {
        key: &'static str,
        value: String,
        source: Cause,
    },
    #[error("cannot open the Zenoh session")]
    Session(#[source] Cause),
    #[error(transparent)]
    Transport(#[from] TransportError),
}
