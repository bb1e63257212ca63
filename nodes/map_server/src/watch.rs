//! Decides when a change of the map's files is complete.
//!
//! Pure: it compares the states passed by the caller. A file that is being written changes between
//! checks, so only a state that is stable for one interval is loaded; after it was judged it is
//! ignored until it changes.

/// Result of a check.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Look {
    /// Nothing has changed since the last judgement.
    Same,
    /// Something changed and may still be changing.
    Changing,
    /// A change is stable: load it, then call [`Watch::judged`].
    Settled,
}

/// States of the files: last judged and last seen.
#[derive(Debug)]
pub(crate) struct Watch<S> {
    judged: S,
    last: S,
}

impl<S: PartialEq + Clone> Watch<S> {
    /// Starts with files that were loaded in state `seen`.
    pub(crate) fn new(seen: S) -> Self {
        Watch {
            judged: seen.clone(),
            last: seen,
        }
    }

    /// Compares the current state with the previous ones.
    pub(crate) fn look(&mut self, seen: S) -> Look {
        let settled = self.last == seen;
        self.last = seen;
        match (self.last == self.judged, settled) {
            (true, _) => Look::Same,
            (false, true) => Look::Settled,
            (false, false) => Look::Changing,
        }
    }

    /// Records that the last seen state was loaded or rejected; `after` is the current state.
    /// Returns false if the files changed meanwhile, so that the outcome must be discarded.
    pub(crate) fn judged(&mut self, after: S) -> bool {
        let stood_still = after == self.last;
        if stood_still {
            self.judged = after.clone();
        }
        self.last = after;
        stood_still
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::files::{Fingerprint, Seen};

    /// Returns two files with these sizes; 0 means missing.
    fn seen(yaml: u64, image: u64) -> Seen {
        let file = |size| {
            (size > 0).then_some(Fingerprint {
                size,
                ..Fingerprint::default()
            })
        };
        Seen {
            yaml: file(yaml),
            image: file(image),
        }
    }

    #[test]
    fn a_file_being_written_is_left_alone_until_it_rests() {
        let mut watch = Watch::new(seen(1, 1));
        assert_eq!(watch.look(seen(1, 1)), Look::Same);
        assert_eq!(watch.look(seen(1, 5)), Look::Changing);
        assert_eq!(watch.look(seen(1, 9)), Look::Changing);
        assert_eq!(watch.look(seen(1, 9)), Look::Settled);
        assert!(watch.judged(seen(1, 9)));
        assert_eq!(watch.look(seen(1, 9)), Look::Same);
    }

    #[test]
    fn a_file_that_is_gone_for_a_moment_is_not_judged() {
        let mut watch = Watch::new(seen(1, 1));
        assert_eq!(watch.look(seen(0, 1)), Look::Changing);
        assert_eq!(watch.look(seen(2, 1)), Look::Changing);
        assert_eq!(watch.look(seen(2, 1)), Look::Settled);
    }

    #[test]
    fn a_file_that_stays_away_is_judged_once() {
        let mut watch = Watch::new(seen(1, 1));
        assert_eq!(watch.look(seen(1, 0)), Look::Changing);
        assert_eq!(watch.look(seen(1, 0)), Look::Settled);
        assert!(watch.judged(seen(1, 0)));
        assert_eq!(watch.look(seen(1, 0)), Look::Same);
    }

    #[test]
    fn a_change_that_is_taken_back_is_none() {
        let mut watch = Watch::new(seen(1, 1));
        assert_eq!(watch.look(seen(1, 2)), Look::Changing);
        assert_eq!(watch.look(seen(1, 1)), Look::Same);
    }

    #[test]
    fn what_changed_while_it_was_loaded_is_loaded_again() {
        let mut watch = Watch::new(seen(1, 1));
        watch.look(seen(1, 2));
        assert_eq!(watch.look(seen(1, 2)), Look::Settled);
        assert!(!watch.judged(seen(1, 3)));
        assert_eq!(watch.look(seen(1, 3)), Look::Settled);
        assert!(watch.judged(seen(1, 3)));
    }
}
