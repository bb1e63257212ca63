//! Decides when a change of the map's files has come to rest.
//!
//! Pure: it compares what the caller saw at each look. A file that is being
//! written changes from look to look, so only what stands still for one whole
//! look is worth loading; what was judged once is left alone until it changes.

/// What a look showed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Look {
    /// Nothing has happened since the last judgement.
    Same,
    /// Something changed and may be changing still.
    Changing,
    /// A change has stood still: load it, then say so by [`Watch::judged`].
    Settled,
}

/// Remembers what was judged last and what was seen last.
#[derive(Debug)]
pub(crate) struct Watch<S> {
    judged: S,
    last: S,
}

impl<S: PartialEq + Clone> Watch<S> {
    /// Starts with files that were loaded as `seen`.
    pub(crate) fn new(seen: S) -> Self {
        Watch {
            judged: seen.clone(),
            last: seen,
        }
    }

    /// Compares a look with the ones before.
    pub(crate) fn look(&mut self, seen: S) -> Look {
        let settled = self.last == seen;
        self.last = seen;
        match (self.last == self.judged, settled) {
            (true, _) => Look::Same,
            (false, true) => Look::Settled,
            (false, false) => Look::Changing,
        }
    }

    /// The files as last seen were loaded or refused; `after` is what they look
    /// like now. If they changed meanwhile the outcome is worth nothing, and
    /// false is returned.
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

    /// A pair of files of these sizes; 0 is not there.
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
