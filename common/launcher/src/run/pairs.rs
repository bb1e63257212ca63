//! Finds for each answer the truth of the same scan, whichever comes first.

use std::collections::VecDeque;

/// The most that wait for their counterpart, on each side. One that never comes
/// (no truth in the recording, a scan that was dropped) is forgotten then.
const CAPACITY: usize = 256;

/// Those that wait for their counterpart, by the time of measurement.
#[derive(Debug)]
pub(crate) struct Pairs<A, B> {
    answers: VecDeque<(i64, A)>,
    truths: VecDeque<(i64, B)>,
}

impl<A, B> Pairs<A, B> {
    /// None.
    pub(crate) fn new() -> Self {
        Pairs {
            answers: VecDeque::new(),
            truths: VecDeque::new(),
        }
    }

    /// An answer came: gives it back with its truth if that is there.
    pub(crate) fn answer(&mut self, measured_ns: i64, answer: A) -> Option<(A, B)> {
        match take(&mut self.truths, measured_ns) {
            Some(truth) => Some((answer, truth)),
            None => {
                keep(&mut self.answers, measured_ns, answer);
                None
            }
        }
    }

    /// A truth came: gives it back with its answer if that is there.
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

/// A recording that is played in a loop repeats its times: the newest counts.
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
