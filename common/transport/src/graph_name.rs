//! Name of a graph, by which its processes find each other; checked once, here.

use std::net::Ipv4Addr;

use twox_hash::XxHash3_64;

use crate::TransportError;
use crate::root::current_user;

/// Environment variable with the name of the graph that a process joins.
pub const GRAPH_VARIABLE: &str = "BACKCAST_GRAPH";

/// A valid graph name: 1 to [`GraphName::CAPACITY`] of `a-z`, `0-9`, `-`, `_`.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub struct GraphName(String);

impl GraphName {
    /// Longest name in bytes; the path of wake-up sockets, of at most 107 bytes, includes it.
    pub const CAPACITY: usize = 20;
    /// Graph that a process joins by default.
    pub const DEFAULT: &'static str = "backcast";

    /// Checks `name`; fails as [`TransportError::GraphName`].
    pub fn new(name: &str) -> Result<Self, TransportError> {
        let allowed = |b: u8| b.is_ascii_lowercase() || b.is_ascii_digit() || b"-_".contains(&b);
        if name.is_empty() || name.len() > Self::CAPACITY || !name.bytes().all(allowed) {
            return Err(TransportError::GraphName { name: name.into() });
        }
        Ok(GraphName(name.into()))
    }

    /// Returns the name in [`GRAPH_VARIABLE`], or [`GraphName::DEFAULT`] if it is unset.
    pub fn from_environment() -> Result<Self, TransportError> {
        match std::env::var_os(GRAPH_VARIABLE) {
            None => Self::new(Self::DEFAULT),
            Some(name) => Self::new(&name.to_string_lossy()),
        }
    }

    /// Returns the loopback address of this graph, on which sockets of its nodes do not collide
    /// with another's (by 1 in 16 million).
    pub fn loopback(&self) -> Ipv4Addr {
        self.loopback_of(current_user())
    }

    fn loopback_of(&self, user: u32) -> Ipv4Addr {
        // All of 127.0.0.0/8 is this machine; 127.0.0.x stays free for others.
        let name = XxHash3_64::oneshot_with_seed(u64::from(user), self.0.as_bytes());
        let [b, c, d, ..] = name.to_le_bytes();
        Ipv4Addr::new(127, b.max(1), c, d.clamp(1, 254))
    }

    /// Replaces the host `graph` of HOST:PORT by [`GraphName::loopback`].
    pub fn resolve(&self, address: &str) -> String {
        match address.strip_prefix("graph:") {
            Some(port) => format!("{}:{port}", self.loopback()),
            None => address.to_owned(),
        }
    }

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
        // Two of a thousand names share an address with a probability of 3 %.
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
