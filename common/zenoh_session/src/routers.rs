//! Whether those are there whom the session is to connect to.

use zenoh::{Session, Wait};

use crate::session::{CONNECT, settings};
use crate::{NetworkError, Options};

/// Where the session is to connect to.
#[derive(Debug, Clone)]
pub struct Routers {
    endpoints: Vec<String>,
}

impl Routers {
    /// As options or the file of the configuration name them.
    ///
    /// # Errors
    /// If the file or an option cannot be used.
    pub fn of(options: &Options) -> Result<Self, NetworkError> {
        let named = settings(options)?.get_json(CONNECT).unwrap_or_default();
        // By the kind of node where the file says so; then nobody is missed.
        let endpoints = serde_json::from_str(&named).unwrap_or_default();
        Ok(Routers { endpoints })
    }

    /// Who is missing before the session is there; empty where nobody was named.
    #[must_use]
    pub fn awaited(&self) -> String {
        match &self.endpoints[..] {
            [] => String::new(),
            endpoints => format!("a router: none at {}", endpoints.join(", ")),
        }
    }

    /// Who is missing: empty as soon as the session has a connection, or where it is to
    /// connect to nobody.
    #[must_use]
    pub fn missing(&self, session: &Session) -> String {
        let is_connected = || session.info().transports().wait().next().is_some();
        match self.endpoints.is_empty() || is_connected() {
            true => String::new(),
            false => self.awaited(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn who_is_missing_is_named() {
        let words = |connect: &[&str]| {
            let connect = connect
                .iter()
                .map(|&endpoint| endpoint.to_owned())
                .collect();
            let options = Options {
                connect,
                ..Options::default()
            };
            Routers::of(&options).unwrap().awaited()
        };
        assert_eq!(words(&[]), "");
        assert_eq!(
            words(&["tcp/10.0.0.1:7447", "tcp/10.0.0.2:7447"]),
            "a router: none at tcp/10.0.0.1:7447, tcp/10.0.0.2:7447"
        );
    }
}
