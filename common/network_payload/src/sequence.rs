//! Detects lost and repeated messages.
//!
//! Each sender has a random session id. Only the newest few are remembered, as a flood may use
//! made-up ids.

use std::collections::VecDeque;

/// Largest number of senders remembered for one topic.
const MOST: usize = 32;

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Arrival {
    New {
        /// Number of messages lost between the last one of this sender and this one.
        lost: u64,
    },
    /// This message, or a later one, was received before.
    Repeated,
}

/// Last number of each sender on one topic. Pure.
#[derive(Debug, Default)]
pub struct Arrivals {
    /// Pairs of sender and last number, the most recent at the back.
    last: VecDeque<(u64, u64)>,
}

impl Arrivals {
    /// Records number `sequence` of `sender`. The first message of a sender shows no loss, as a
    /// subscriber may join late.
    pub fn note(&mut self, sender: u64, sequence: u64) -> Arrival {
        let known = self.last.iter().position(|&(id, _)| id == sender);
        let known = known.and_then(|at| self.last.remove(at));
        if known.is_none() && self.last.len() == MOST {
            self.last.pop_front();
        }
        let newest = known.map_or(sequence, |(_, last)| last.max(sequence));
        self.last.push_back((sender, newest));
        match known {
            None => Arrival::New { lost: 0 },
            Some((_, last)) if sequence <= last => Arrival::Repeated,
            Some((_, last)) => Arrival::New {
                lost: sequence - last - 1,
            },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn losses_and_repetitions_are_reported_for_each_sender() {
        let mut arrivals = Arrivals::default();
        let mut note = |sender, sequence| arrivals.note(sender, sequence);
        assert_eq!(note(1, 5), Arrival::New { lost: 0 });
        assert_eq!(note(1, 6), Arrival::New { lost: 0 });
        assert_eq!(note(2, 0), Arrival::New { lost: 0 });
        assert_eq!(note(1, 9), Arrival::New { lost: 2 });
        assert_eq!(note(1, 9), Arrival::Repeated);
        assert_eq!(note(1, 7), Arrival::Repeated);
        assert_eq!(
            note(1, u64::MAX),
            Arrival::New {
                lost: u64::MAX - 10
            }
        );
        assert_eq!(note(2, 1), Arrival::New { lost: 0 });
    }

    #[test]
    fn made_up_senders_do_not_fill_the_memory() {
        let mut arrivals = Arrivals::default();
        for sender in 0..10_000 {
            arrivals.note(sender, 0);
        }
        assert_eq!(arrivals.last.len(), MOST);
        assert_eq!(arrivals.note(9_999, 0), Arrival::Repeated);
    }
}
