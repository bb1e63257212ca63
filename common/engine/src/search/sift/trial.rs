//! Which sample of the beams is swept at all headings: one that leaves few poses where it is
//! tried.

use super::samples::{self, First};
use super::{FEW_COUNTS, Sifting};

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
        if samples::is_least_enough(task) {
            let possible = self.sift.samples.all()[0].highest_possible();
            let least = (possible * 3 / 4) as u16;
            return Some(First { sample: 0, least });
        }
        let expected = samples::expected_floor(task, self.program);
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
}
