//! The name of a graph, by which its processes find each other.
//!
//! A name is checked once, here; everything derived from it (the prefix of
//! files in shared memory) may rely on its characters and length.

use crate::TransportError;

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
