//! The name of a graph, by which its processes find each other.
//!
//! A name is checked once, here; everything derived from it (the prefix of
//! files in shared memory) may rely on its characters and length.

use std::net::Ipv4Addr;

use twox_hash::XxHash3_64;

use crate::TransportError;
use crate::root::current_user;

/// The environment variable that names the graph which a process joins.
pub const GRAPH_VARIABLE: &str = "BACKCAST_GRAPH";

/// A valid graph name: 1 to [`GraphName::CAPACITY`] of `a-z`, `0-9`, `-`, `_`.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub struct GraphName(String);

impl GraphName {
    /// Most bytes of a name. Wake-up sockets carry the name in their path, and
    /// a socket's path has at most 107 bytes, most of which are taken.
    pub const CAPACITY: usize = 20;
    /// The graph that a process joins if nobody names another.
    pub const DEFAULT: &'static str = "backcast";

    /// Checks `name`.
    ///
    /// # Errors
    /// [`TransportError::GraphName`] if it is empty, too long, or holds another
    /// character than those allowed.
    pub fn new(name: &str) -> Result<Self, TransportError> {
        let allowed = |b: u8| b.is_ascii_lowercase() || b.is_ascii_digit() || b"-_".contains(&b);
        if name.is_empty() || name.len() > Self::CAPACITY || !name.bytes().all(allowed) {
            return Err(TransportError::GraphName { name: name.into() });
        }
        Ok(GraphName(name.into()))
    }

    /// The name in [`GRAPH_VARIABLE`], or [`GraphName::DEFAULT`] where it is unset.
    ///
    /// # Errors
    /// [`TransportError::GraphName`] if the variable holds no valid name.
    pub fn from_environment() -> Result<Self, TransportError> {
        match std::env::var_os(GRAPH_VARIABLE) {
            None => Self::new(Self::DEFAULT),
            Some(name) => Self::new(&name.to_string_lossy()),
        }
    }

    /// An address of this machine alone that is the graph's own: what its nodes
    /// say to each other over sockets does not meet another graph, or one of the same
    /// name of another user. Two share one in 16 million times.
    #[must_use]
    pub fn loopback(&self) -> Ipv4Addr {
        self.loopback_of(current_user())
    }

    fn loopback_of(&self, user: u32) -> Ipv4Addr {
        // All of 127.0.0.0/8 is this machine; 127.0.0.x stays free for others.
        let name = XxHash3_64::oneshot_with_seed(u64::from(user), self.0.as_bytes());
        let [b, c, d, ..] = name.to_le_bytes();
        Ipv4Addr::new(127, b.max(1), c, d.clamp(1, 254))
    }

    /// HOST:PORT where the host `graph` means [`GraphName::loopback`].
    #[must_use]
    pub fn resolve(&self, address: &str) -> String {
        match address.strip_prefix("graph:") {
            Some(port) => format!("{}:{port}", self.loopback()),
            None => address.to_owned(),
        }
    }

    /// The text.
    #[must_use]
    pub fn as_str(&self) -> &str {
        &self.0
    }
}

impl std::fmt::Display for GraphName {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.pad(&self.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_has_its_own_loopback_address() {
        let address = |name: &str| GraphName::new(name).unwrap().loopback();
        assert!(address("backcast").is_loopback());
        assert_eq!(address("bc7"), address("bc7"));
        let name = GraphName::new("bc7").unwrap();
        assert_ne!(name.loopback_of(1000), name.loopback_of(1001));
        assert_eq!(
            name.resolve("graph:2112"),
            format!("{}:2112", address("bc7"))
        );
        assert_eq!(name.resolve("10.0.0.9:2112"), "10.0.0.9:2112");
        let all: std::collections::BTreeSet<_> =
            (0..1000).map(|pid| address(&format!("bc{pid}"))).collect();
        // By chance two of a thousand share one in 3 % of all choices of names.
        assert!(all.len() >= 999, "{}", all.len());
    }

    #[test]
    fn takes_short_plain_names_only() {
        for name in ["backcast", "a", "robot-7_b", &"x".repeat(20)] {
            assert_eq!(GraphName::new(name).unwrap().as_str(), name);
        }
        for name in ["", "a.b", "a/b", "Robot", "ä", "a b", &"x".repeat(21)] {
            let error = GraphName::new(name).unwrap_err();
            assert!(matches!(error, TransportError::GraphName { name: n } if n == name));
        }
    }
}
