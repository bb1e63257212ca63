//! Decides when a search is worse than counting every pose.
//!
//! In uniform clutter bounds do not distinguish blocks. The search tallies its work, and
//! gives up once that is a quarter of what counting every pose takes: on maps of buildings
//! even the slowest searches take less. Costs are in nanoseconds with AVX2 on a processor of
//! 2 GHz; only ratios matter.

use crate::grid::Grid;
use crate::program::ScanProgram;
use crate::space::Space;

/// Work that was done since it was last taken.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Tally {
    /// Words that were read for bounds from sets.
    pub reads: u64,
    /// Bounds of blocks from intervals, 64 headings each.
    pub windows: u64,
    /// Sectors of beams that were counted at a heading.
    pub sectors: u64,
    /// Directions in which rays were cast.
    pub casts: u64,
}

/// Cost of a search so far, and its limits.
#[derive(Debug)]
pub(crate) struct Budget {
    /// Cost at which the search ends, done or not.
    limit: f64,
    /// Cost of counting every pose.
    counting: f64,
    spent: f64,
}

// Measured cost of the parts of a search, in nanoseconds.
const READ: f64 = 1.0;
const WINDOW_PER_BEAM: f64 = 1.8;
const SECTOR: f64 = 40.0;
const CAST: f64 = 60.0;
/// Cost of counting every pose, for each heading, cell and beam.
const VOTE: f64 = 0.03;

/// Cost at which a search is given up, as a share of counting every pose: this much is lost.
const HOPELESS: f64 = 0.25;

/// Returns the cost of counting every pose.
pub(crate) fn of_brute_force(grid: &Grid, program: &ScanProgram, space: &Space) -> f64 {
    let fields = (grid.cells().len() * space.directions.count()) as f64;
    fields * program.beams() as f64 * VOTE
}

impl Tally {
    /// Cost of the work with this many beams.
    pub(crate) fn cost(&self, beams: usize) -> f64 {
        self.reads as f64 * READ
            + self.windows as f64 * WINDOW_PER_BEAM * beams as f64
            + self.sectors as f64 * SECTOR
            + self.casts as f64 * CAST
    }
}

impl Budget {
    /// Returns the budget of one of `parts` of a search, which takes `most_steps` at most.
    pub(crate) fn new(brute_force: f64, most_steps: f64, parts: usize) -> Self {
        Budget {
            limit: most_steps / parts as f64,
            counting: brute_force / parts as f64,
            spent: 0.0,
        }
    }

    /// Adds the cost of a block.
    pub(crate) fn spend(&mut self, cost: f64) {
        self.spent += cost;
    }

    /// Cost of the search so far.
    pub(crate) fn spent(&self) -> f64 {
        self.spent
    }

    /// True if the search has to end, counting the cost spent on other maps.
    pub(crate) fn is_used_up(&self, elsewhere: f64) -> bool {
        self.spent + elsewhere >= self.limit
    }

    /// True if every pose is to be counted instead, which is done before the search has to end.
    pub(crate) fn is_hopeless(&self, elsewhere: f64) -> bool {
        self.spent >= self.counting * HOPELESS
            && self.spent + elsewhere + self.counting <= self.limit
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_search_is_given_up_after_a_quarter_of_the_cost_of_counting() {
        let mut budget = Budget::new(800.0, f64::INFINITY, 2);
        budget.spend(99.0);
        assert!(!budget.is_hopeless(0.0));
        budget.spend(1.0);
        assert!(budget.is_hopeless(0.0));
    }

    #[test]
    fn a_search_ends_where_its_limit_is_used_up() {
        let mut budget = Budget::new(500.0, 600.0, 2);
        budget.spend(70.0);
        assert!(
            budget.is_hopeless(-20.0),
            "counting ends at the limit of 300"
        );
        assert!(!budget.is_hopeless(0.0), "and would end beyond it");
        assert!(!budget.is_used_up(229.0) && budget.is_used_up(230.0));
    }
}
