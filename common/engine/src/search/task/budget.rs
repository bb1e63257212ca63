//! Decides when a search is worse than counting every pose.
//!
//! In uniform clutter bounds do not distinguish blocks. The search tallies its work,
//! estimates the rest from the cost of the blocks of each level so far, and gives up if
//! counting every pose would be done sooner. If that is seen at the first look, a tenth of
//! the cost of brute force is lost.

use crate::grid::Grid;
use crate::instruction_set::InstructionSet;
use crate::program::ScanProgram;
use crate::space::Space;

/// Number of sizes of blocks in the queue of a search.
pub(in crate::search) const LEVELS: usize = 3;

/// Work, in nanoseconds on a processor of 2 GHz. Only ratios matter.
#[derive(Debug, Clone, Copy, PartialEq, PartialOrd)]
pub(in crate::search) struct Cost(pub f64);

/// Work that was done since it was last taken.
#[derive(Debug, Clone, Copy, Default)]
pub(in crate::search) struct Tally {
    /// Words that were read for bounds from sets, ever.
    pub reads: u64,
    reads_before: u64,
    /// Bounds of blocks from intervals, 64 headings each.
    pub windows: u64,
    /// Sectors of beams that were counted at a heading.
    pub sectors: u64,
    /// Directions in which rays were cast, ever.
    pub casts: u64,
    casts_before: u64,
}

/// Cost of a search so far, and its limits.
#[derive(Debug)]
pub(in crate::search) struct Budget {
    /// Cost of the rest above which the search is given up.
    most: f64,
    /// Cost at which the search ends, done or not.
    limit: f64,
    /// Cost of counting every pose.
    counting: f64,
    spent: f64,
    /// Cost at which to look again.
    next: f64,
    /// Number of blocks of each level that were taken from the queue, and their cost.
    taken: [(f64, f64); LEVELS],
}

/// Measured cost of the parts of a search, in nanoseconds.
#[derive(Debug, Clone, Copy)]
struct Rates {
    read: f64,
    window_per_beam: f64,
    sector: f64,
    cast: f64,
    /// Counting every pose, for each heading, cell and beam.
    vote: f64,
}

impl Rates {
    fn of(instruction_set: InstructionSet) -> Self {
        match instruction_set {
            InstructionSet::Avx2 => Rates {
                read: 1.0,
                window_per_beam: 1.8,
                sector: 40.0,
                cast: 60.0,
                vote: 0.03,
            },
            InstructionSet::Portable => Rates {
                read: 3.5,
                window_per_beam: 15.0,
                sector: 75.0,
                cast: 200.0,
                vote: 0.9,
            },
        }
    }
}

/// Share of the work that goes into the smallest blocks before their turn.
const LEAF_SHARE: f64 = 0.4;

/// Cost at the first look, as a share of that of brute force: this much is lost if a search
/// is given up then.
const FIRST_LOOK: f64 = 0.1;

/// Factor from the cost at a look to the cost at the next one.
const NEXT_LOOK: f64 = 1.5;

/// Expected cost of the rest, as a multiple of counting every pose, above which a search is
/// given up. The blocks that are left have lower bounds and cost less, down to half of
/// those before; and at first the best pose may not be known, so that the floor is still
/// low.
const HOPELESS: f64 = 2.5;

impl Cost {
    /// Cost of counting every pose.
    pub(in crate::search) fn of_brute_force(
        instruction_set: InstructionSet,
        grid: &Grid,
        program: &ScanProgram,
        space: &Space,
    ) -> Self {
        let fields = (grid.cells().len() * space.directions.count()) as f64;
        Cost(fields * program.beams() as f64 * Rates::of(instruction_set).vote)
    }
}

impl Tally {
    /// Returns the cost of the work since the last call, with this many beams.
    pub(in crate::search) fn take(
        &mut self,
        instruction_set: InstructionSet,
        beams: usize,
    ) -> Cost {
        let (rates, beams) = (Rates::of(instruction_set), beams as f64);
        let cost = (self.reads - self.reads_before) as f64 * rates.read
            + self.windows as f64 * rates.window_per_beam * beams
            + self.sectors as f64 * rates.sector
            + (self.casts - self.casts_before) as f64 * rates.cast;
        *self = Tally {
            casts: self.casts,
            casts_before: self.casts,
            reads: self.reads,
            reads_before: self.reads,
            ..Tally::default()
        };
        Cost(cost)
    }
}

impl Budget {
    /// Returns the budget of one of `parts` of a search, which takes `most_steps` at most.
    pub(in crate::search) fn new(brute_force: Cost, most_steps: f64, parts: usize) -> Self {
        let brute_force = brute_force.0 / parts as f64;
        Budget {
            most: brute_force * HOPELESS,
            limit: most_steps / parts as f64,
            counting: brute_force,
            spent: 0.0,
            next: brute_force * FIRST_LOOK,
            taken: [(0.0, 0.0); LEVELS],
        }
    }

    /// Adds the cost of a block of a level.
    pub(in crate::search) fn spend(&mut self, level: usize, cost: Cost) {
        self.spent += cost.0;
        self.taken[level].0 += 1.0;
        self.taken[level].1 += cost.0;
    }

    /// True if the smallest block with the highest bound comes next, even if larger blocks have
    /// higher bounds: as long as the smallest blocks have cost a small part.
    pub(in crate::search) fn prefers_leaves(&self) -> bool {
        self.taken[LEVELS - 1].1 < self.spent * LEAF_SHARE
    }

    /// True if it is time to estimate the rest.
    pub(in crate::search) fn is_up(&self) -> bool {
        self.spent >= self.next
    }

    /// Cost of the search so far.
    pub(in crate::search) fn spent(&self) -> f64 {
        self.spent
    }

    /// True if the search has to end, counting the cost spent on other maps.
    pub(in crate::search) fn is_used_up(&self, elsewhere: f64) -> bool {
        self.spent + elsewhere >= self.limit
    }

    /// True if counting every pose would be done sooner than the blocks `left` of each level,
    /// and before the search has to end. Sets the time of the next look.
    pub(in crate::search) fn is_hopeless(&mut self, left: [usize; LEVELS], elsewhere: f64) -> bool {
        self.next = self.spent * NEXT_LOOK;
        if self.spent + elsewhere + self.counting > self.limit {
            return false;
        }
        let mut below = 0.0;
        // A block costs as much as those of its level did, and as much as the blocks that come from
        // it will.
        let mut expected = 0.0;
        for level in (0..LEVELS).rev() {
            let (taken, cost) = self.taken[level];
            let each = if taken > 0.0 { cost / taken } else { 0.0 };
            let children = match self.taken.get(level + 1) {
                Some(&(children, _)) if taken > 0.0 => (children + left[level + 1] as f64) / taken,
                _ => 0.0,
            };
            below = each + children * below;
            expected += left[level] as f64 * below;
        }
        expected > self.most
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_search_is_given_up_where_what_is_left_costs_more() {
        let mut budget = Budget::new(Cost(2.0 * 3_550.0 / HOPELESS), f64::INFINITY, 2);
        assert!(!budget.is_up());
        // Four coarse blocks came to eight fine ones, of which three were taken.
        for _ in 0..4 {
            budget.spend(0, Cost(100.0));
        }
        for _ in 0..3 {
            budget.spend(1, Cost(500.0));
        }
        assert!(budget.is_up());
        // Five fine ones cost 500 each; a coarse one 100, and twice 500.
        assert!(!budget.is_hopeless([0, 5, 0], 0.0));
        assert!(!budget.is_up(), "not at once again");
        assert!(budget.is_hopeless([1, 5, 0], 0.0));
    }

    #[test]
    fn the_smallest_blocks_come_before_their_turn_while_they_cost_little() {
        let mut budget = Budget::new(Cost(1.0), f64::INFINITY, 1);
        assert!(!budget.prefers_leaves(), "nothing was done");
        budget.spend(0, Cost(100.0));
        assert!(budget.prefers_leaves());
        budget.spend(LEVELS - 1, Cost(10.0));
        assert!(budget.prefers_leaves());
        budget.spend(LEVELS - 1, Cost(60.0));
        assert!(!budget.prefers_leaves(), "70 of 170");
    }

    #[test]
    fn a_search_ends_where_its_limit_is_used_up() {
        let mut budget = Budget::new(Cost(500.0), 600.0, 2);
        budget.spend(0, Cost(60.0));
        assert!(budget.is_up() && !budget.is_used_up(239.0), "of 300");
        assert!(budget.is_used_up(240.0));
        // Counting takes 250 of them, and all that is left more.
        assert!(!budget.is_hopeless([1000, 0, 0], 0.0));
        budget.spend(0, Cost(240.0));
        assert!(budget.is_used_up(0.0));
    }

    #[test]
    fn a_tally_counts_each_thing_once() {
        let mut tally = Tally {
            reads: 1,
            windows: 2,
            sectors: 3,
            casts: 4,
            ..Tally::default()
        };
        let (best, rates) = (InstructionSet::best(), Rates::of(InstructionSet::best()));
        let cost =
            rates.read + 2.0 * rates.window_per_beam * 10.0 + 3.0 * rates.sector + 4.0 * rates.cast;
        assert_eq!(tally.take(best, 10), Cost(cost));
        assert_eq!(tally.take(best, 10), Cost(0.0));
    }
}
