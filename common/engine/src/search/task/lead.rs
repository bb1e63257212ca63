//! The best pose so far, of all maps that are searched together.

#[cfg(all(test, loom))]
use loom::sync::atomic::AtomicU32;
#[cfg(not(all(test, loom)))]
use std::sync::atomic::AtomicU32;
use std::sync::atomic::Ordering;

use crate::votes::VoteShare;

/// Share of the votes that the best pose has, in one word, so that threads need no lock. A
/// caller that knows of a pose on another map may raise it while a search runs.
#[derive(Debug)]
pub(crate) struct Lead(AtomicU32);

impl Default for Lead {
    /// Returns a lead without any votes.
    fn default() -> Self {
        Lead(AtomicU32::new(pack(VoteShare::default())))
    }
}

impl Lead {
    /// Raises the lead to the share of a pose that was counted, if that is greater.
    pub(crate) fn raise(&self, share: VoteShare) {
        let better = |now| share.compare(unpack(now)).is_gt().then(|| pack(share));
        // It only rises, in any order of the threads.
        let _ = self
            .0
            .fetch_update(Ordering::Relaxed, Ordering::Relaxed, better);
    }

    /// Returns the share of the best pose.
    pub(crate) fn share(&self) -> VoteShare {
        unpack(self.0.load(Ordering::Relaxed))
    }

    /// Returns the least number of votes that is as good as the best pose, on a map where
    /// `possible` votes are the most.
    pub(crate) fn on(&self, possible: u16) -> u16 {
        let best = self.share();
        match best.possible == possible {
            true => best.votes,
            false => best.on(possible),
        }
    }
}

fn pack(share: VoteShare) -> u32 {
    u32::from(share.votes) << 16 | u32::from(share.possible)
}

fn unpack(packed: u32) -> VoteShare {
    VoteShare::new((packed >> 16) as u16, packed as u16)
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
            poses.iter().for_each(|&(votes, of)| lead.raise(VoteShare::new(votes, of)));
            let on = lead.on(possible);
            let reaches = |votes: u16| poses.iter().all(|&(best, of)| {
                u64::from(votes) * u64::from(of) >= u64::from(best) * u64::from(possible)
            });
            prop_assert!(reaches(on) && (on == 0 || !reaches(on - 1)), "{on}");
            let backward = Lead::default();
            poses.iter().rev().for_each(|&(votes, of)| backward.raise(VoteShare::new(votes, of)));
            prop_assert_eq!(backward.on(possible), on);
        }
    }
}

/// Threads in every order that `loom` can tell apart, with what they may read at `Relaxed`.
#[cfg(all(test, loom))]
mod orders {
    use loom::thread;

    use super::*;

    #[test]
    fn the_greatest_share_leads_in_any_order_and_none_is_lost() {
        loom::model(|| {
            let lead: &'static Lead = Box::leak(Box::default());
            let raise = |votes: [u16; 2]| {
                move || {
                    let mut before = 0;
                    for votes in votes {
                        lead.raise(VoteShare::new(votes, 100));
                        let now = lead.on(100);
                        assert!(now >= votes && now >= before, "it only rises");
                        before = now;
                    }
                }
            };
            let others = [
                thread::spawn(raise([30, 20])),
                thread::spawn(raise([10, 40])),
            ];
            assert!([0, 10, 30, 40].contains(&lead.on(100)));
            others.into_iter().for_each(|other| other.join().unwrap());
            assert_eq!(lead.on(100), 40);
        });
    }
}
