//! Decides when a change of the map's files is complete.
//!
//! Pure: it compares the states passed by the caller. A file that is being written changes between
//! checks, so only a state that is stable for one interval is loaded; after it was judged it is
//! ignored until it changes.

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
    /// Checks the results for states of the files, given as numbers; the first one was loaded.
    fn check(states: &[u8], expected: &[Look]) {
        let mut watch = Watch::new(states[0]);
        let found: Vec<Look> = states[1..].iter().map(|&seen| watch.look(seen)).collect();
        assert_eq!(found, expected, "{states:?}");
    }

    #[test]
    fn only_a_change_that_rests_is_settled() {
        use Look::{Changing, Same, Settled};
        check(&[1, 1, 5, 9, 9], &[Same, Changing, Changing, Settled]);
        // Taken back.
        check(&[1, 2, 1], &[Changing, Same]);
        // Missing for a moment.
        check(&[1, 0, 2, 2], &[Changing, Changing, Settled]);
    }

    #[test]
    fn what_is_judged_is_left_alone_unless_it_changed_meanwhile() {
        let mut watch = Watch::new(1);
        watch.look(2);
        assert_eq!(watch.look(2), Look::Settled);
        assert!(!watch.judged(3));
        assert_eq!(watch.look(3), Look::Settled);
        assert!(watch.judged(3));
        assert_eq!(watch.look(3), Look::Same);
    }
}
