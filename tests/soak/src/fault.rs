//! Faults, and the order in which they are injected. Pure.

use std::time::Duration;

use rand::SeedableRng;
use rand::rngs::Xoshiro256PlusPlus;
use rand::seq::{IndexedRandom, SliceRandom};
use serde::Serialize;

/// A fault of a running graph.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, clap::ValueEnum)]
#[serde(rename_all = "snake_case")]
pub(crate) enum Fault {
    /// A node is killed
    Kill,
    /// Two nodes are killed at once
    Pair,
    /// A node is stopped for ten seconds
    Stop,
    /// The map is replaced by one of another size that shows the same place
    Map,
    /// The launcher is killed and, once its nodes have ended, started again
    Launcher,
    /// The graph's files in the temporary folder are removed
    Tmp,
    /// /dev/shm is full for a second: only where it is small
    Shm,
    /// The disk of --record is full for three seconds: only where it is small
    Disk,
}

impl Fault {
    /// Duration; the time to the next pose counts from its end.
    pub(crate) fn lasts(self) -> Duration {
        Duration::from_secs(match self {
            Fault::Stop => 10,
            Fault::Shm => 1,
            Fault::Disk => 3,
            _ => 0,
        })
    }

    pub(crate) fn nodes(self) -> usize {
        match self {
            Fault::Kill | Fault::Stop => 1,
            Fault::Pair => 2,
            _ => 0,
        }
    }

    /// Frequency within a round: faults with quick recovery come most often.
    fn share(self) -> usize {
        match self {
            Fault::Kill => 8,
            Fault::Pair => 4,
            _ => 1,
        }
    }
}

/// Draws faults in rounds; each round contains all faults by frequency, in random order.
#[derive(Debug)]
pub(crate) struct Draw {
    faults: Vec<Fault>,
    round: Vec<Fault>,
    random: Xoshiro256PlusPlus,
}

impl Draw {
    pub(crate) fn new(faults: &[Fault], seed: u64) -> Self {
        Draw {
            faults: faults.to_owned(),
            round: Vec::new(),
            random: Xoshiro256PlusPlus::seed_from_u64(seed),
        }
    }

    pub(crate) fn fault(&mut self) -> Option<Fault> {
        if self.round.is_empty() {
            let shares = self.faults.iter();
            self.round = shares
                .flat_map(|fault| std::iter::repeat_n(*fault, fault.share()))
                .collect();
            self.round.shuffle(&mut self.random);
        }
        self.round.pop()
    }

    pub(crate) fn some_of<'n, T>(&mut self, all: &'n [T], count: usize) -> Vec<&'n T> {
        all.sample(&mut self.random, count).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_round_has_each_fault_in_its_share_and_a_seed_repeats_it() {
        let faults = [Fault::Kill, Fault::Pair, Fault::Map];
        let drawn = |seed| {
            let mut draw = Draw::new(&faults, seed);
            let round = (0..13).filter_map(|_| draw.fault());
            round.collect::<Vec<_>>()
        };
        let one = drawn(1);
        assert_eq!(one, drawn(1));
        assert_ne!(one, drawn(2));
        let times = |fault| one.iter().filter(|drawn| **drawn == fault).count();
        assert_eq!(faults.map(times), [8, 4, 1]);
        assert_eq!(Draw::new(&[], 1).fault(), None);
    }
}
