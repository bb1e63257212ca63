//! What small blocks see in directions in which their intervals say little.
//!
//! A block that looks past corners sees near and far, and little between. Two intervals
//! hold what lies between, too; so where they are wide the bins are noted one by one, for
//! the sets that are made of the intervals. Searches do not need that any more.

use super::strip_blocks::StripBlocks;
use crate::program::NO_RANGE;
use crate::search::index::bits;
use crate::search::index::steps::BinSteps;

/// Neighbouring bins that are noted together, as a power of two: a block of 8 × 8 cells
/// smears distances by more.
pub(crate) const ROW_SHIFT: u32 = 2;

/// Intervals are wide if the ends of both lie this many bins apart, in sum: four rows. On
/// real maps at most 7 in a hundred are; noting more of them gains nothing.
pub(super) const WIDE: u8 = 16;

/// What a block sees in a direction in which its intervals are wide.
#[derive(Debug, Clone, Copy)]
pub(super) struct WideView {
    block: u32,
    direction: u16,
    rows: u64,
}

/// What all blocks see where their intervals are wide.
#[derive(Debug, Clone)]
pub(crate) struct WideViews {
    /// Where the views of each block start, and behind them where the last ones end.
    starts: Vec<u32>,
    directions: Vec<u16>,
    /// A bit for each `1 << ROW_SHIFT` bins.
    rows: Vec<u64>,
}

impl WideViews {
    /// Sorts the views of this many blocks.
    pub(super) fn new(blocks: usize, lists: &[Vec<WideView>]) -> Self {
        let mut starts = vec![0; blocks + 1];
        for view in lists.iter().flatten() {
            starts[view.block as usize] += 1;
        }
        let mut at = 0;
        for start in &mut starts {
            at += *start;
            *start = at;
        }
        let (mut directions, mut rows) = (vec![0; at as usize], vec![0; at as usize]);
        for view in lists.iter().flatten() {
            let start = &mut starts[view.block as usize];
            *start -= 1;
            directions[*start as usize] = view.direction;
            rows[*start as usize] = view.rows;
        }
        WideViews {
            starts,
            directions,
            rows,
        }
    }

    /// The directions in which the intervals of a block, by its number, are wide, and a bit for each
    /// `1 << ROW_SHIFT` bins that it sees there.
    pub(crate) fn of(&self, block: usize) -> impl Iterator<Item = (usize, u64)> {
        let views = self.starts[block] as usize..self.starts[block + 1] as usize;
        let directions = self.directions[views.clone()].iter();
        directions
            .map(|&direction| usize::from(direction))
            .zip(self.rows[views].iter().copied())
    }
}

/// Where the wide views of a strip of blocks in one direction are noted.
pub(super) struct Noting<'a> {
    pub views: &'a mut Vec<WideView>,
    pub steps: &'a BinSteps,
    pub direction: usize,
    pub class: usize,
    pub blocks: &'a StripBlocks<'a>,
}

impl Noting<'_> {
    /// Notes what some of the strip's blocks see, from `start` on, by the ranges of
    /// their cells.
    pub(super) fn note(&mut self, start: usize, among: u64, cells: &[&[u16]]) {
        for i in bits::ones(among).map(|lane| start + lane) {
            let ranges = cells.iter().map(|cells| cells[i]);
            let seen = ranges.filter(|&range| range != 0 && range != NO_RANGE);
            let rows = seen.map(|range| self.steps.bin(self.class, range) >> ROW_SHIFT);
            self.views.push(WideView {
                block: self.blocks.id(i) as u32,
                direction: self.direction as u16,
                rows: rows.fold(0, |rows, row| rows | 1 << row),
            });
        }
    }
}
