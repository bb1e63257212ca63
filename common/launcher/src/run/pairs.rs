//! Pairs each answer with the ground truth of the same scan; either may come first.

use std::collections::VecDeque;

/// Largest number of waiting entries on each side. The oldest is dropped beyond it, since its
/// counterpart may never come (no truth in the recording, a dropped scan).
const CAPACITY: usize = 256;

/// Answers and truths that wait for their counterpart, by time of measurement.
#[derive(Debug)]
pub(crate) struct Pairs<A, B> {
    answers: VecDeque<(i64, A)>,
    truths: VecDeque<(i64, B)>,
}

impl<A, B> Pairs<A, B> {
    pub(crate) fn new() -> Self {
        Pairs {
            answers: VecDeque::new(),
            truths: VecDeque::new(),
        }
    }

    /// Adds an answer; returns the pair if its truth is known.
    pub(crate) fn answer(&mut self, measured_ns: i64, answer: A) -> Option<(A, B)> {
        match take(&mut self.truths, measured_ns) {
            Some(truth) => Some((answer, truth)),
            None => {
                keep(&mut self.answers, measured_ns, answer);
                None
            }
        }
    }

    /// Adds a truth; returns the pair if its answer is known.
    pub(crate) fn truth(&mut self, measured_ns: i64, truth: B) -> Option<(A, B)> {
        match take(&mut self.answers, measured_ns) {
            Some(answer) => Some((answer, truth)),
            None => {
                keep(&mut self.truths, measured_ns, truth);
                None
            }
        }
    }
}

fn take<T>(waiting: &mut VecDeque<(i64, T)>, at: i64) -> Option<T> {
    let index = waiting.iter().position(|(ns, _)| *ns == at)?;
    waiting.remove(index).map(|(_, item)| item)
}

/// Adds an entry. It replaces one of the same time, as a looped recording repeats its times.
fn keep<T>(waiting: &mut VecDeque<(i64, T)>, at: i64, item: T) {
    take(waiting, at);
    if waiting.len() == CAPACITY {
        waiting.pop_front();
    }
    waiting.push_back((at, item));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pairs_in_either_order() {
        let mut pairs = Pairs::new();
        assert_eq!(pairs.answer(1, "a1"), None);
        assert_eq!(pairs.truth(2, "t2"), None);
        assert_eq!(pairs.truth(1, "t1"), Some(("a1", "t1")));
        assert_eq!(pairs.answer(2, "a2"), Some(("a2", "t2")));
        assert_eq!(pairs.answer(2, "again"), None, "each is used once");
    }

    #[test]
    fn a_loop_repeats_its_times() {
        let mut pairs = Pairs::new();
        assert_eq!(pairs.truth(1, "first round, scan dropped"), None);
        assert_eq!(pairs.truth(1, "second round"), None);
        assert_eq!(pairs.answer(1, "a"), Some(("a", "second round")));
        assert_eq!(pairs.answer(1, "a"), None);
    }

    #[test]
    fn what_nobody_asks_for_is_forgotten() {
        let mut pairs: Pairs<(), i64> = Pairs::new();
        for ns in 0..=CAPACITY as i64 {
            assert_eq!(pairs.truth(ns, ns), None);
        }
        assert_eq!(pairs.answer(0, ()), None);
        assert_eq!(pairs.answer(1, ()), Some(((), 1)));
    }
}
