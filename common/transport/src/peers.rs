//! Processes at the other end of a topic.

/// The subscribers of a publisher, or the publishers of a subscriber, at one moment. A killed one
/// is included until it has been cleaned up; a restarted process is a new peer.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Peers(pub(crate) Vec<u128>);

impl Peers {
    /// True if there is a peer that was not in `before`.
    #[must_use]
    pub fn any_new_since(&self, before: &Peers) -> bool {
        self.0.iter().any(|id| !before.0.contains(id))
    }
}
