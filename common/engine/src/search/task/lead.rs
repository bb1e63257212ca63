//! The best pose so far, of all maps that are searched together.

use std::sync::atomic::{AtomicU32, Ordering};

/// The votes of the best pose as a share of the highest possible on its map: a fraction of
/// whole numbers, so that maps with other cells are compared without rounding.
#[derive(Debug)]
pub(in crate::search) struct Lead(AtomicU32);

impl Default for Lead {
    /// No pose has a vote so far.
    fn default() -> Self {
        Lead(AtomicU32::new(pack(0, 1)))
    }
}

impl Lead {
    /// Takes a pose that was counted, on a map on which such a number of votes is possible.
    pub(in crate::search) fn raise(&self, votes: u16, possible: u16) {
        let better = |now| {
            let (best, of) = unpack(now);
            let is_better = product(votes, of) > product(best, possible);
            is_better.then(|| pack(votes, possible))
        };
        // It only rises, whoever is first.
        let _ = self
            .0
            .fetch_update(Ordering::Relaxed, Ordering::Relaxed, better);
    }

    /// The least number of votes that is as good as the best pose, on a map on which such a
    /// number is possible.
    pub(in crate::search) fn on(&self, possible: u16) -> u16 {
        let (best, of) = unpack(self.0.load(Ordering::Relaxed));
        match of == possible {
            true => best,
            false => product(best, possible).div_ceil(of.into()) as u16,
        }
    }
}

fn product(a: u16, b: u16) -> u32 {
    u32::from(a) * u32::from(b)
}

fn pack(votes: u16, possible: u16) -> u32 {
    u32::from(votes) << 16 | u32::from(possible)
}

fn unpack(packed: u32) -> (u16, u16) {
    ((packed >> 16) as u16, packed as u16)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn the_greatest_share_leads_whoever_comes_first(
            poses in proptest::collection::vec((0u16..=u16::MAX, 1u16..=u16::MAX), 1..20),
            possible in 1u16..=u16::MAX,
        ) {
            let poses: Vec<(u16, u16)> = poses.into_iter().map(|(a, b)| (a.min(b), b)).collect();
            let lead = Lead::default();
            poses.iter().for_each(|&(votes, of)| lead.raise(votes, of));
            let on = lead.on(possible);
            let reaches = |votes: u16| poses.iter().all(|&(best, of)| {
                u64::from(votes) * u64::from(of) >= u64::from(best) * u64::from(possible)
            });
            prop_assert!(reaches(on) && (on == 0 || !reaches(on - 1)), "{on}");
            let backward = Lead::default();
            poses.iter().rev().for_each(|&(votes, of)| backward.raise(votes, of));
            prop_assert_eq!(backward.on(possible), on);
        }
    }
}
