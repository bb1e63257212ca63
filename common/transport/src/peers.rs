//! Processes at the other end of a topic.

/// Ids of a topic's other side at one moment; a killed peer counts until it is cleaned up.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Peers(pub(crate) Vec<u128>);

impl Peers {
    /// True if there is a peer that was not in `before`.
    pub fn any_new_since(&self, before: &Peers) -> bool {
        self.0.iter().any(|id| !before.0.contains(id))
    }
}
