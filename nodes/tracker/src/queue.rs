//! What waits to be used: scans for their turn, and hypotheses for their scans.

use std::collections::VecDeque;

use messages::{Hypothesis, ScanHeader, Stamp};

/// Scans and answers that are kept: two seconds of a fast laser.
const KEPT: usize = 128;

/// Scans in the order in which they came.
#[derive(Debug, Default)]
pub(crate) struct Scans {
    waiting: VecDeque<(ScanHeader, Vec<f32>)>,
    /// Room of scans that are done with.
    spare: Vec<Vec<f32>>,
}

impl Scans {
    /// Takes a scan; returns how many were dropped for it, the oldest first.
    pub(crate) fn push(&mut self, header: &ScanHeader, ranges: &[f32]) -> u64 {
        let mut room = self.spare.pop().unwrap_or_default();
        room.clear();
        room.extend_from_slice(ranges);
        self.waiting.push_back((*header, room));
        let is_full = self.waiting.len() > KEPT;
        if is_full && let Some((_, room)) = self.waiting.pop_front() {
            self.spare.push(room);
        }
        u64::from(is_full)
    }

    /// The next one, given to `take`.
    pub(crate) fn pop<R>(&mut self, take: impl FnOnce(&ScanHeader, &[f32]) -> R) -> Option<R> {
        let (header, room) = self.waiting.pop_front()?;
        let taken = take(&header, &room);
        self.spare.push(room);
        Some(taken)
    }
}

/// The newest answers of searches.
#[derive(Debug, Default)]
pub(crate) struct Answers {
    kept: VecDeque<(Stamp, Vec<Hypothesis>)>,
}

impl Answers {
    /// Takes an answer. The first one to a scan counts: asked again, a searcher may say
    /// that it does not keep that scan any more.
    pub(crate) fn push(&mut self, stamp: Stamp, hypotheses: &[Hypothesis]) {
        if self.of(stamp).is_some_and(|found| !found.is_empty()) {
            return;
        }
        let mut room = match self.kept.len() {
            KEPT => self.kept.pop_front().map(|(_, room)| room),
            _ => None,
        }
        .unwrap_or_default();
        room.clear();
        room.extend_from_slice(hypotheses);
        self.kept.push_back((stamp, room));
    }

    /// Whether there is one to a scan that entered the graph after this one.
    pub(crate) fn any_after(&self, stamp: Stamp) -> bool {
        self.kept
            .iter()
            .any(|(of, _)| of.entered_ns > stamp.entered_ns)
    }

    /// That of a scan.
    pub(crate) fn of(&self, stamp: Stamp) -> Option<&[Hypothesis]> {
        let mut newest_first = self.kept.iter().rev();
        let found = newest_first.find(|(of, _)| of.is_of(stamp));
        found.map(|(_, hypotheses)| &hypotheses[..])
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
        let next = scans.pop(|header, ranges| (header.stamp.counter, ranges.to_vec()));
        assert_eq!(next, Some((2, vec![2.0])));
    }

    #[test]
    fn answers_are_found_by_their_scan() {
        let mut answers = Answers::default();
        for counter in 0..=KEPT as u64 {
            answers.push(
                stamp(counter),
                &[Zeroable::zeroed(); 2][..counter.min(2) as usize],
            );
        }
        assert_eq!(answers.of(stamp(0)), None);
        assert_eq!(answers.of(stamp(1)).map(<[_]>::len), Some(1));
        assert_eq!(answers.of(stamp(KEPT as u64)).map(<[_]>::len), Some(2));
    }

    #[test]
    fn the_first_answer_to_a_scan_counts_unless_it_was_empty() {
        let mut answers = Answers::default();
        let some = [Zeroable::zeroed(); 2];
        for found in [&[][..], &some, &[], &some[..1]] {
            answers.push(stamp(3), found);
        }
        assert_eq!(answers.of(stamp(3)).map(<[_]>::len), Some(2));
    }

    #[test]
    fn an_answer_to_a_later_scan_is_noticed() {
        let entered = |entered_ns| Stamp {
            entered_ns,
            ..Stamp::default()
        };
        let mut answers = Answers::default();
        assert!(!answers.any_after(entered(5)));
        answers.push(entered(5), &[]);
        assert!(answers.any_after(entered(4)) && !answers.any_after(entered(5)));
    }
}
