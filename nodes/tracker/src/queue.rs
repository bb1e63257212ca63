//! Queues of scans waiting for their turn and of hypotheses waiting for their scans.

use std::collections::VecDeque;

use messages::{HypothesesHeader, Hypothesis, ScanHeader, Stamp, Verdict};

/// Number of scans and answers kept: two seconds of a fast laser.
const KEPT: usize = 128;

#[derive(Debug, Default)]
pub(crate) struct Scans(VecDeque<(ScanHeader, Vec<f32>)>);

impl Scans {
    /// Adds a scan and drops the oldest one if the queue is full; returns the number dropped.
    pub(crate) fn push(&mut self, header: &ScanHeader, ranges: &[f32]) -> u64 {
        self.0.push_back((*header, ranges.to_vec()));
        u64::from(self.0.len() > KEPT && self.0.pop_front().is_some())
    }

    pub(crate) fn pop(&mut self) -> Option<(ScanHeader, Vec<f32>)> {
        self.0.pop_front()
    }
}

#[derive(Debug)]
pub(crate) struct Answer {
    of: Stamp,
    /// Id of the searched maps, from the header.
    pub(crate) searched: u64,
    pub(crate) verdict: Option<Verdict>,
    pub(crate) found: Vec<Hypothesis>,
}

#[derive(Debug, Default)]
pub(crate) struct Answers {
    kept: VecDeque<Answer>,
}

impl Answers {
    /// Adds a search result; only the first of a scan counts, as its votes may be forgotten.
    pub(crate) fn push(&mut self, header: &HypothesesHeader, hypotheses: &[Hypothesis]) {
        let (of, searched) = (header.stamp, header.searched);
        let is_late = |before: &Answer| searched == 0 || searched == before.searched;
        if self.of(of).is_some_and(is_late) {
            return;
        }
        if self.kept.len() == KEPT {
            self.kept.pop_front();
        }
        self.kept.push_back(Answer {
            of,
            searched,
            verdict: Verdict::from_code(header.verdict),
            found: hypotheses.to_vec(),
        });
    }

    /// Returns true if there is a result for a scan that entered the graph after this one.
    pub(crate) fn any_after(&self, stamp: Stamp) -> bool {
        let mut kept = self.kept.iter();
        kept.any(|answer| answer.of.entered_ns > stamp.entered_ns)
    }

    pub(crate) fn of(&self, stamp: Stamp) -> Option<&Answer> {
        let mut newest_first = self.kept.iter().rev();
        newest_first.find(|answer| answer.of.is_of(stamp))
    }
}

#[cfg(test)]
mod tests {
    use bytemuck::Zeroable;

    use super::*;

    fn stamp(counter: u64) -> Stamp {
        Stamp {
            counter,
            ..Stamp::default()
        }
    }

    #[test]
    fn scans_come_in_their_order_and_the_oldest_are_dropped() {
        let mut scans = Scans::default();
        let mut dropped = 0;
        for counter in 0..KEPT as u64 + 2 {
            let header = ScanHeader {
                stamp: stamp(counter),
                ..Zeroable::zeroed()
            };
            dropped += scans.push(&header, &[counter as f32]);
        }
        assert_eq!(dropped, 2);
        let (header, ranges) = scans.pop().unwrap();
        assert_eq!((header.stamp.counter, &*ranges), (2, &[2.0][..]));
    }

    fn header(stamp: Stamp, searched: u64) -> HypothesesHeader {
        HypothesesHeader {
            stamp,
            searched,
            ..Zeroable::zeroed()
        }
    }

    #[test]
    fn answers_are_found_by_their_scan() {
        let mut answers = Answers::default();
        for counter in 0..=KEPT as u64 {
            answers.push(
                &header(stamp(counter), 7),
                &[Zeroable::zeroed(); 2][..counter.min(2) as usize],
            );
        }
        let found = |counter| answers.of(stamp(counter)).map(|answer| answer.found.len());
        assert_eq!(found(0), None);
        assert_eq!((found(1), found(KEPT as u64)), (Some(1), Some(2)));
    }

    #[test]
    fn the_first_search_of_a_scan_counts() {
        let mut answers = Answers::default();
        let mut push = |searched, found: usize| {
            answers.push(
                &header(stamp(3), searched),
                &[Zeroable::zeroed(); 2][..found],
            );
            let answer = answers.of(stamp(3)).unwrap();
            (answer.searched, answer.found.len())
        };
        assert_eq!(push(0, 0), (0, 0));
        assert_eq!(push(7, 2), (7, 2));
        // The scan is no longer kept, or is searched again.
        assert_eq!(push(0, 0), (7, 2));
        assert_eq!(push(7, 1), (7, 2));
        // The same scan on other maps.
        assert_eq!(push(8, 1), (8, 1));
    }

    #[test]
    fn an_answer_to_a_later_scan_is_noticed() {
        let entered = |entered_ns| Stamp {
            entered_ns,
            ..Stamp::default()
        };
        let mut answers = Answers::default();
        assert!(!answers.any_after(entered(5)));
        answers.push(&header(entered(5), 7), &[]);
        assert!(answers.any_after(entered(4)) && !answers.any_after(entered(5)));
    }
}
