//! Detects missing connections to the configured endpoints.

use zenoh::{Session, Wait};

use crate::session::{CONNECT, settings};
use crate::{NetworkError, Options};

/// Endpoints that the session should connect to.
#[derive(Debug, Clone)]
pub struct Routers {
    endpoints: Vec<String>,
}

impl Routers {
    /// Reads the endpoints from the options or the configuration file.
    pub fn of(options: &Options) -> Result<Self, NetworkError> {
        let named = settings(options)?.get_json(CONNECT).unwrap_or_default();
        // If the file has endpoints by mode, they are ignored and none is reported missing.
        let endpoints = serde_json::from_str(&named).unwrap_or_default();
        Ok(Routers { endpoints })
    }

    /// Returns a text on the missing routers before the session is open; empty without endpoints.
    pub fn awaited(&self) -> String {
        match &self.endpoints[..] {
            [] => String::new(),
            endpoints => format!("a router: none at {}", endpoints.join(", ")),
        }
    }

    /// Returns a text on the missing routers; empty if the session has a connection or no
    /// endpoints.
    pub fn missing(&self, session: &Session) -> String {
        let is_connected = || session.info().transports().wait().next().is_some();
        match self.endpoints.is_empty() || is_connected() {
            true => String::new(),
            false => self.awaited(),
        }
    }
}
