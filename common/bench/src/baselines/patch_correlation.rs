//! Correlation with a patch, the paper's comparison (its [5], Konolige and Chou): the scan is drawn
//! as a small local map, which is correlated with the global map at each pose. It ignores obstacles
//! along the beams.

use std::collections::HashMap;

use engine::space::Space;

use super::Baseline;
use super::best::{Best, Estimate};
use super::correlation::{Correlation, Together};
use super::reading::Readings;
use crate::worlds::World;

const FULL: u16 = 15;

/// Number of rows of zeros and ones whose sum fits eight bits.
const TOGETHER: usize = u8::MAX as usize;

#[derive(Debug, Clone)]
pub struct PatchCorrelation(Correlation);

/// A cell of the patch, relative to the laser.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct PatchCell {
    weight: u16,
    dy: i32,
    dx: i32,
}

impl PatchCorrelation {
    /// Prepares a map. Only its boundary counts, since no beam ends inside an obstacle.
    pub fn new(world: &World, space: &Space) -> Self {
        let boundary = world.is_boundary().into_iter().map(u8::from);
        PatchCorrelation(Correlation::new(world, space, boundary.collect()))
    }
}

/// Correlation of a patch with the map pose by pose, as the paper describes it.
#[derive(Debug, Clone)]
pub struct PlainCorrelation(PatchCorrelation);

impl PlainCorrelation {
    pub fn new(world: &World, space: &Space) -> Self {
        PlainCorrelation(PatchCorrelation::new(world, space))
    }
}

impl Baseline for PlainCorrelation {
    fn locate(&mut self, readings: &Readings, headings: &[usize]) -> Option<Estimate> {
        let PatchCorrelation(correlation) = &self.0;
        let boundary = &correlation.image;
        let mut best = Best::default();
        for &heading in headings {
            let patch = patch(readings, &correlation.space, heading);
            for y in 0..boundary.height {
                let shifted = |cell: &PatchCell| {
                    Some((boundary.shifted(y, (cell.dx, cell.dy))?, cell.weight))
                };
                let cells: Vec<(usize, u16)> = patch.iter().filter_map(shifted).collect();
                let row = correlation.open(y).iter().enumerate();
                for (x, _) in row.filter(|&(_, &open)| open) {
                    let votes =
                        |&(at, weight): &(usize, u16)| weight * u16::from(boundary.bytes()[at + x]);
                    let sum: u16 = cells.iter().map(votes).sum();
                    best.take(Estimate::new(x, y, heading, f32::from(sum)));
                }
            }
        }
        best.get()
    }

    fn bytes(&self) -> usize {
        self.0.bytes()
    }
}

impl Baseline for PatchCorrelation {
    fn locate(&mut self, readings: &Readings, headings: &[usize]) -> Option<Estimate> {
        self.0.best(headings, |heading| {
            let patch = patch(readings, &self.0.space, heading);
            let same = patch.chunk_by(|a, b| a.weight == b.weight);
            let together = |cells: &[PatchCell]| Together {
                cells: cells.iter().map(|cell| (cell.dx, cell.dy)).collect(),
                weight: cells[0].weight,
            };
            same.flat_map(|same| same.chunks(TOGETHER))
                .map(together)
                .collect()
        })
    }

    fn bytes(&self) -> usize {
        self.0.bytes()
    }
}

/// Draws the scan: along each beam a taper of two standard deviations on both sides of the reading,
/// with the highest weight where beams cross. Sorted by weight.
fn patch(readings: &Readings, space: &Space, heading: usize) -> Vec<PatchCell> {
    let mut heights: HashMap<(i32, i32), f64> = HashMap::new();
    for reading in &readings.beams {
        let angle = (heading + reading.bearing) as f64 * space.directions.spacing();
        let (sin, cos) = angle.sin_cos();
        let reach = (2.0 * reading.sigma_cells).floor() as i32;
        for offset in -reach..=reach {
            let distance = reading.cells + f64::from(offset);
            if distance > 0.0 {
                let deviations = f64::from(offset) / reading.sigma_cells;
                let height = (-0.5 * deviations * deviations).exp();
                let cell = (
                    (distance * cos).round() as i32,
                    (distance * sin).round() as i32,
                );
                let highest = heights.entry(cell).or_insert(0.0);
                *highest = highest.max(height);
            }
        }
    }
    // Like votes, the weights are lowered until their sum fits sixteen bits.
    let sum: f64 = heights.values().sum();
    let full = f64::from(FULL)
        .min((f64::from(u16::MAX) / sum).floor())
        .max(1.0);
    let cell = |(&(dx, dy), &height): (&(i32, i32), &f64)| PatchCell {
        weight: (full * height).round() as u16,
        dy,
        dx,
    };
    let mut cells: Vec<PatchCell> = heights
        .iter()
        .map(cell)
        .filter(|cell| cell.weight > 0)
        .collect();
    cells.sort_unstable();
    cells
}

#[cfg(test)]
mod tests {
    use std::collections::HashSet;

    use engine::instruction_set::InstructionSet;

    use super::super::tests::{best_of, noisy};
    use super::*;

    #[test]
    fn the_best_pose_is_that_of_plain_sums_on_every_instruction_set() {
        let (world, space, scans) = noisy(24, 24);
        let mut correlation = PatchCorrelation::new(&world, &space);
        let headings: Vec<usize> = (0..24).collect();
        let cells = world.boundary.iter();
        let boundary: HashSet<(i64, i64)> =
            cells.map(|cell| (cell.x.into(), cell.y.into())).collect();
        for readings in scans {
            let plain = best_of(&world, |heading| {
                let patch = patch(&readings, &space, heading);
                let boundary = &boundary;
                move |x, y| {
                    let meets = |cell: &&PatchCell| {
                        boundary.contains(&(x + i64::from(cell.dx), y + i64::from(cell.dy)))
                    };
                    patch.iter().filter(meets).map(|cell| cell.weight).sum()
                }
            });
            let found = PlainCorrelation(correlation.clone()).locate(&readings, &headings);
            assert_eq!(found, plain);
            for set in InstructionSet::available() {
                correlation.0.instructions = set;
                assert_eq!(correlation.locate(&readings, &headings), plain, "{set}");
            }
        }
    }
}
