//! Judges answers by the ground truth of the same scan; either may come first.

use std::collections::VecDeque;

use answers::statistics::{Accuracy, Answer, Figures};
use geometry::Pose;

/// Largest number of waiting entries on each side, as a counterpart may never come.
const CAPACITY: usize = 256;

/// Answers and truths that wait for their counterpart, and the accuracy of those that met.
#[derive(Debug)]
pub(crate) struct Pairs {
    answers: VecDeque<(i64, Answer)>,
    truths: VecDeque<(i64, Pose)>,
    accuracy: Accuracy,
}

impl Pairs {
    /// Creates empty figures. Errors keep the newest `window` values.
    pub(crate) fn new(window: usize) -> Self {
        Pairs {
            answers: VecDeque::new(),
            truths: VecDeque::new(),
            accuracy: Accuracy::new(window),
        }
    }

    pub(crate) fn answer(&mut self, measured_ns: i64, answer: Answer) {
        match take(&mut self.truths, measured_ns) {
            Some(truth) => self.accuracy.add(truth, &answer),
            None => keep(&mut self.answers, measured_ns, answer),
        }
    }

    pub(crate) fn truth(&mut self, measured_ns: i64, truth: Pose) {
        match take(&mut self.answers, measured_ns) {
            Some(answer) => self.accuracy.add(truth, &answer),
            None => keep(&mut self.truths, measured_ns, truth),
        }
    }

    pub(crate) fn figures(&self) -> Figures {
        self.accuracy.figures()
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
    fn the_newest_of_a_time_counts_and_what_nobody_asks_for_is_forgotten() {
        let mut waiting = VecDeque::new();
        keep(&mut waiting, 0, "first round, scan dropped");
        keep(&mut waiting, 0, "second round");
        assert_eq!(take(&mut waiting, 0), Some("second round"));
        assert_eq!(take(&mut waiting, 0), None, "each is used once");
        (0..=CAPACITY as i64).for_each(|at| keep(&mut waiting, at, ""));
        assert_eq!(waiting.len(), CAPACITY);
        assert_eq!(take(&mut waiting, 0), None);
    }
}
