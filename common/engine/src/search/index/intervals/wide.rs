//! Views of small blocks in directions in which their intervals are wide.
//!
//! A block that looks past corners sees near and far surfaces and little between, but its
//! two intervals hold the bins between, too. So where they are wide, the bins are noted one
//! by one for the sets that are made from the intervals. Once these are made, the views are
//! dropped.

use super::strip_blocks::StripBlocks;
use crate::program::NO_RANGE;
use crate::search::index::bins::Bins;
use crate::search::index::bits;

/// Number of neighbouring bins that are noted together, as a power of two: a block of 8 × 8
/// cells blurs distances by more.
pub(crate) const ROW_SHIFT: u32 = 2;

/// Sum of the widths of both intervals, in bins, from which on they are wide: four rows. On
/// real maps at most 7 in a hundred are; noting more of them gains nothing.
pub(super) const WIDE: u8 = 16;

/// Bins that a block sees in a direction in which its intervals are wide.
#[derive(Debug, Clone, Copy)]
pub(super) struct WideView {
    block: u32,
    direction: u16,
    rows: u64,
}

/// Views of all blocks in the directions in which their intervals are wide.
#[derive(Debug, Clone)]
pub(crate) struct WideViews {
    /// Start of the views of each block, and at last the end of them all.
    starts: Vec<u32>,
    directions: Vec<u16>,
    /// A bit for each `1 << ROW_SHIFT` bins.
    rows: Vec<u64>,
}

impl WideViews {
    /// Sorts views by block; `blocks` is the number of blocks.
    pub(super) fn new(blocks: usize, views: &[WideView]) -> Self {
        let mut starts = vec![0; blocks + 1];
        for view in views {
            starts[view.block as usize] += 1;
        }
        let mut at = 0;
        for start in &mut starts {
            at += *start;
            *start = at;
        }
        let (mut directions, mut rows) = (vec![0; at as usize], vec![0; at as usize]);
        for view in views {
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

    /// Returns the directions in which the intervals of a block, given by its number, are wide,
    /// each with a bit for each `1 << ROW_SHIFT` bins that the block sees there.
    pub(crate) fn of(&self, block: usize) -> impl Iterator<Item = (usize, u64)> {
        let views = self.starts[block] as usize..self.starts[block + 1] as usize;
        let directions = self.directions[views.clone()].iter();
        directions
            .map(|&direction| usize::from(direction))
            .zip(self.rows[views].iter().copied())
    }
}

/// Output for the wide views of a strip of blocks in one direction.
pub(super) struct Noting<'a> {
    pub views: &'a mut Vec<WideView>,
    pub bins: &'a Bins,
    pub direction: usize,
    pub class: usize,
    pub blocks: &'a StripBlocks<'a>,
}

impl Noting<'_> {
    /// Notes the bins that some of the strip's blocks see, by the ranges of their cells;
    /// `among` has a bit for each block from `start` on.
    pub(super) fn note(&mut self, start: usize, among: u64, cells: &[&[u16]]) {
        for i in bits::ones(among).map(|lane| start + lane) {
            let ranges = cells.iter().map(|cells| cells[i]);
            let seen = ranges.filter(|&range| range != 0 && range != NO_RANGE);
            let rows = seen.map(|range| self.bins.bin(self.class, range) >> ROW_SHIFT);
            self.views.push(WideView {
                block: self.blocks.id(i) as u32,
                direction: self.direction as u16,
                rows: rows.fold(0, |rows, row| rows | 1 << row),
            });
        }
    }
}
