//! Processes at the other end of a topic.

/// The subscribers of a publisher, or the publishers of a subscriber, at one moment. A killed one
/// is included until it has been cleaned up; a restarted process is a new peer.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Peers {
    ids: Vec<u128>,
}

impl Peers {
    pub(crate) fn of(ids: Vec<u128>) -> Self {
        Peers { ids }
    }

    /// True if there is a peer that was not in `before`.
    #[must_use]
    pub fn any_new_since(&self, before: &Peers) -> bool {
        self.ids.iter().any(|id| !before.ids.contains(id))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn who_comes_is_new_and_who_leaves_is_not() {
        let peers = |ids: &[u128]| Peers::of(ids.to_vec());
        assert!(!peers(&[1, 2]).any_new_since(&peers(&[2, 1])));
        assert!(!peers(&[2]).any_new_since(&peers(&[1, 2])));
        assert!(!Peers::default().any_new_since(&peers(&[1])));
        assert!(peers(&[1, 3]).any_new_since(&peers(&[1, 2])));
        assert!(peers(&[1]).any_new_since(&Peers::default()));
    }
}
