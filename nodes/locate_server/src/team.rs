//! Servers of one map and the choice of the one that takes a request. Each knows only what it has
//! forwarded; an overloaded one says so. Pure.

use std::collections::BTreeMap;

/// Other servers of the same map, by session.
#[derive(Debug, Default)]
pub(crate) struct Team {
    others: BTreeMap<String, Other>,
}

#[derive(Debug)]
struct Other {
    /// Start time by its own clock, nanoseconds since 1970.
    since: u64,
    workers: usize,
    pending: usize,
}

impl Team {
    pub(crate) fn join(&mut self, session: &str, since: u64, workers: usize) {
        let other = Other {
            since,
            workers: workers.max(1),
            pending: 0,
        };
        self.others.entry(session.to_owned()).or_insert(other);
    }

    pub(crate) fn leave(&mut self, session: &str) {
        self.others.remove(session);
    }

    pub(crate) fn has(&self, session: &str) -> bool {
        self.others.contains_key(session)
    }

    /// True if a server started at `since` leads: the oldest, so that a new one never takes over.
    pub(crate) fn is_led_by(&self, since: u64, session: &str) -> bool {
        let mut others = self.others.iter();
        others.all(|(name, other)| (since, session) < (other.since, name.as_str()))
    }

    /// Returns the server with the lowest load per worker, if that is below the load here, where
    /// `busy` requests share `workers`, and counts a request for it.
    pub(crate) fn hand_on(&mut self, busy: usize, workers: usize) -> Option<String> {
        // With a free worker here, no other server is faster.
        if busy < workers {
            return None;
        }
        // Cross-multiplied, because integer division would lose the fraction.
        let less = |a: &Other, b: &Other| (a.pending * b.workers).cmp(&(b.pending * a.workers));
        let (session, other) = self.others.iter_mut().min_by(|a, b| less(a.1, b.1))?;
        if other.pending * workers >= busy * other.workers {
            return None;
        }
        other.pending += 1;
        Some(session.clone())
    }

    pub(crate) fn done(&mut self, session: &str) {
        if let Some(other) = self.others.get_mut(session) {
            other.pending = other.pending.saturating_sub(1);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn who_has_a_free_worker_answers() {
        let mut team = Team::default();
        assert_eq!(team.hand_on(9, 2), None, "nobody else is there");
        team.join("b", 0, 4);
        assert_eq!(team.hand_on(1, 2), None);
        assert_eq!(team.hand_on(2, 2).as_deref(), Some("b"));
    }

    #[test]
    fn who_has_the_least_to_do_for_each_worker_is_next() {
        let mut team = Team::default();
        team.join("b", 0, 1);
        team.join("c", 0, 2);
        let mut next = || team.hand_on(2, 2).unwrap();
        let turns: Vec<String> = (0..3).map(|_| next()).collect();
        assert_eq!(turns, ["b", "c", "c"]);
        // All have the same load as this one.
        assert_eq!(team.hand_on(2, 2), None);
        team.done("c");
        assert_eq!(team.hand_on(2, 2).as_deref(), Some("c"));
    }

    #[test]
    fn who_is_there_longest_takes_the_requests_to_all() {
        let mut team = Team::default();
        assert!(team.is_led_by(5, "b"), "nobody else is there");
        team.join("a", 6, 1);
        assert!(team.is_led_by(5, "b"));
        // Of two that started at the same time, only one leads.
        team.join("c", 5, 1);
        assert!(team.is_led_by(5, "b"));
        assert!(!team.is_led_by(5, "d"));
        team.join("e", 4, 1);
        assert!(!team.is_led_by(5, "b"));
        team.leave("e");
        assert!(team.is_led_by(5, "b"));
    }

    #[test]
    fn who_is_gone_is_not_asked() {
        let mut team = Team::default();
        team.join("b", 0, 1);
        assert!(team.hand_on(1, 1).is_some());
        // Joining twice still counts as one server.
        team.join("b", 0, 1);
        assert!(team.hand_on(1, 1).is_none());
        assert!(team.has("b"));
        team.leave("b");
        assert!(!team.has("b"));
        team.done("b");
        assert!(team.hand_on(1, 1).is_none());
    }
}
