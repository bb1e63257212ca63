//! Correlation of a scan with an image of the map, row by row: what the methods that see through
//! walls have in common.

use engine::grid::Cell;
use engine::instruction_set::InstructionSet;
use engine::space::Space;

use super::best::{Best, Estimate};
use super::padded::Padded;
use super::row_sums::{self, Group};
use crate::worlds::World;

#[derive(Debug, Clone)]
pub(super) struct Correlation {
    pub(super) space: Space,
    pub(super) image: Padded,
    open: Vec<bool>,
    pub(super) instructions: InstructionSet,
}

/// Cells relative to the laser, so few that the sum of their pixels fits eight bits.
pub(super) struct Together {
    pub(super) cells: Vec<(i32, i32)>,
    pub(super) weight: u16,
}

impl Correlation {
    /// Prepares an image of as many pixels as the world has cells.
    pub(super) fn new(world: &World, space: &Space, image: Vec<u8>) -> Self {
        let cells = world.grid.cells().iter();
        Correlation {
            space: space.clone(),
            image: Padded::new(world.grid.width(), image.into_iter()),
            open: cells.map(|&cell| cell == Cell::Open).collect(),
            instructions: InstructionSet::best(),
        }
    }

    pub(super) fn bytes(&self) -> usize {
        self.image.bytes().len() + self.open.len()
    }

    /// Open cells of a row of the map.
    pub(super) fn open(&self, y: usize) -> &[bool] {
        &self.open[y * self.image.width..][..self.image.width]
    }

    /// The pose at these headings with the highest sum of weighted pixels.
    pub(super) fn best(
        &self,
        headings: &[usize],
        cells_at: impl Fn(usize) -> Vec<Together>,
    ) -> Option<Estimate> {
        let mut best = Best::default();
        let mut sums = vec![0; self.image.row];
        let (mut offsets, mut groups) = (Vec::new(), Vec::new());
        for &heading in headings {
            let together = cells_at(heading);
            for y in 0..self.image.height {
                offsets.clear();
                groups.clear();
                for Together { cells, weight } in &together {
                    let start = offsets.len();
                    offsets.extend(cells.iter().filter_map(|&cell| self.image.shifted(y, cell)));
                    let (end, weight) = (offsets.len(), *weight);
                    groups.push(Group { start, end, weight });
                }
                let bytes = self.image.bytes();
                row_sums::fill(self.instructions, bytes, &offsets, &groups, &mut sums);
                take_row(&mut best, &sums, self.open(y), y, heading);
            }
        }
        best.get()
    }
}

/// Adds the best pose of a row, if it is better. Rows come in order, so ties go to the first.
fn take_row(best: &mut Best, sums: &[u16], open: &[bool], y: usize, heading: usize) {
    let score = best.score();
    // Most rows contain nothing better, which one pass decides.
    let both = sums.iter().zip(open);
    let most = both.map(|(&sum, &open)| sum * u16::from(open)).max();
    if most.is_none_or(|most| f32::from(most) <= score) {
        return;
    }
    let cells = sums.iter().zip(open).enumerate();
    for (x, (&sum, _)) in cells.filter(|(_, (_, open))| **open) {
        best.take(Estimate::new(x, y, heading, f32::from(sum)));
    }
}
