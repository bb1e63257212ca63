//! The best vote of each distinct place.
//!
//! Votes of neighbouring poses make up one peak. The best vote starts a place, all votes near it
//! belong to the same place, and so on down the list.

use geometry::angle_between;
use messages::Vote;

use super::PeakInput;
use crate::votes::is_close;

/// A place, given by its best vote.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Summit {
    pub vote: Vote,
    /// Number of votes that belong to the place.
    pub support: u64,
}

/// Largest distance between poses of one place.
#[derive(Debug, Clone, Copy)]
pub(super) struct Reach {
    cells: f64,
    /// Angle in radians.
    angle: f64,
}

impl Reach {
    pub(super) fn new(input: &PeakInput<'_>, metres: f64, degrees: f64) -> Self {
        Reach {
            cells: metres / input.frame.resolution_m,
            angle: degrees.to_radians(),
        }
    }
}

impl PeakInput<'_> {
    pub(super) fn heading_of(&self, vote: &Vote) -> f64 {
        f64::from(vote.heading) * std::f64::consts::TAU / f64::from(self.headings)
    }

    pub(super) fn are_near(&self, a: &Vote, b: &Vote, reach: Reach) -> bool {
        let (dx, dy) = (
            f64::from(a.x) - f64::from(b.x),
            f64::from(a.y) - f64::from(b.y),
        );
        dx * dx + dy * dy <= reach.cells * reach.cells
            && angle_between(self.heading_of(a), self.heading_of(b)) <= reach.angle
    }
}

/// Fills in the best vote of each place, best first: at most `most`, or up to `most_close` while
/// they are close to the best one in votes.
pub(super) fn find(
    input: &PeakInput<'_>,
    reach: Reach,
    (most, most_close): (usize, usize),
    summits: &mut Vec<Summit>,
) {
    summits.clear();
    let best = input.lead as u16;
    for vote in input.votes {
        let near = |summit: &&mut Summit| input.are_near(&summit.vote, vote, reach);
        if let Some(summit) = summits.iter_mut().find(near) {
            summit.support += 1;
        } else if summits.len() < most
            || summits.len() < most_close && is_close(vote.intensity, best)
        {
            let vote = *vote;
            summits.push(Summit { vote, support: 1 });
        } else {
            break;
        }
    }
}
