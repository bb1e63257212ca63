//! Which sample of the beams is swept at all headings: one that leaves few poses where it is
//! tried.

use super::samples::{self, First};
use super::{FEW_COUNTS, Sifting};

/// At so many headings the best poses but one have about as many votes as the last of the
/// leading ones: so it was seen in clutter where sixteen are wanted.
const TRIED: usize = 6;

/// Where samples are tried, a decisive one leaves this part of the poses that may be
/// counted one by one: other headings have more, and the best pose may have fewer votes
/// than expected.
const LEFT_BY_DECISIVE: usize = 6;

impl Sifting<'_> {
    /// The smallest sample that leaves few poses at some heading, where the poses that are
    /// wanted have as many votes as expected; `None` where there is none. It ends early,
    /// with none, where it is told to stop.
    pub(super) fn decisive(&mut self) -> Option<First> {
        let task = self.task;
        if task.leaders.is_none() && samples::is_least_enough(task) {
            let possible = self.sift.samples.all()[0].highest_possible();
            let least = (possible * 3 / 4) as u16;
            return Some(First { sample: 0, least });
        }
        let expected = samples::expected_floor(task, self.program);
        let expected = match task.leaders {
            Some(_) => expected.max(self.most_votes()?),
            None => expected,
        };
        let heading = task.sought().next()?;
        let most = (self.most_counts() / LEFT_BY_DECISIVE).max(FEW_COUNTS / 2);
        for (i, sample) in self.sift.samples.all().iter().enumerate() {
            let least = expected.saturating_sub(self.rest(sample));
            // In clutter most poses have about half of the votes.
            if u32::from(least) > sample.highest_possible() / 2 {
                self.sweep(sample, heading)?;
                self.share.least = least;
                if self.share.keep(most) {
                    return Some(First { sample: i, least });
                }
            }
        }
        None
    }

    /// The most votes of any pose at some headings but one, near which the best pose of all
    /// may be.
    fn most_votes(&mut self) -> Option<u16> {
        let sought = self.task.sought();
        let apart = sought.clone().count().div_ceil(TRIED).max(1);
        let (mut most, mut second) = (0, 0);
        for heading in sought.step_by(apart) {
            self.sweep(self.program, heading)?;
            let votes = self.share.field.iter().copied().fold(0, u16::max);
            second = second.max(votes.min(most));
            most = most.max(votes);
        }
        Some(second)
    }
}
