//! Markov localization and reverse projection exactly as the paper describes them (section II B),
//! at a known heading, counting every operation. They serve only for counting: the engine and the
//! baselines are faster.

use std::ops::AddAssign;

use engine::accumulator::Query;
use engine::directions::Direction;
use engine::grid::Cell;
use engine::reference;

use crate::baselines::Readings;
use crate::worlds::World;

#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Counts {
    /// Operations: in Markov localization ranges, squarings and Gaussians, n(2m + 1) by the formula;
    /// in reverse projection obstacles found along θ - π and readings converted to cells and
    /// intensities, without those that end behind an obstacle, 2mp at worst.
    pub operations: u64,
    /// Additions and subtractions: 2mn, or kmp at worst.
    pub additions: u64,
    /// Additions without obstacles in between, the paper's kmp.
    pub worst_additions: u64,
}

impl AddAssign for Counts {
    fn add_assign(&mut self, other: Self) {
        self.operations += other.operations;
        self.additions += other.additions;
        self.worst_additions += other.worst_additions;
    }
}

/// Markov localization at one heading: returns the likelihood of the readings in each cell, row by
/// row from the lowest y, 0 in cells that are not free; and the operations.
pub fn markov(world: &World, readings: &Readings, query: Query<'_>) -> (Vec<f64>, Counts) {
    let mut counts = Counts::default();
    let grid = &world.grid;
    let mut belief = vec![0.0; grid.cells().len()];
    for (i, likelihood) in belief.iter_mut().enumerate() {
        let (x, y) = ((i % grid.width()) as i64, (i / grid.width()) as i64);
        if !grid.is_open(x, y) {
            continue;
        }
        let mut sum = 0.0;
        for beam in &readings.beams {
            let direction = query.space.directions.get(query.heading + beam.bearing);
            counts.operations += 1;
            let steps = reference::range(grid, x, y, direction);
            let cells = steps.map_or(f64::INFINITY, |steps| {
                f64::from(steps) / direction.steps_per_cell
            });
            counts.additions += 1;
            let error = (cells - beam.cells) / beam.sigma_cells;
            counts.operations += 1;
            let square = error * error;
            counts.additions += 1;
            sum += square;
        }
        counts.operations += 1;
        *likelihood = (-0.5 * sum).exp();
    }
    (belief, counts)
}

/// Reverse projection at one heading: projects all readings back from all boundary cells. Calls `add`
/// with each cell that a taper reaches, and its votes.
pub fn reverse_projection(
    world: &World,
    query: Query<'_>,
    mut add: impl FnMut(usize, u8),
) -> Counts {
    let mut counts = Counts::default();
    let mut visible = Vec::new();
    for cell in &world.boundary {
        for beam in 0..query.program.beams() {
            let (direction, taper) = query.beam(beam);
            let first = (taper.centre + 1).saturating_sub(taper.profile.len() as u16);
            let first = first.max(1);
            counts.worst_additions += u64::from(taper.end().saturating_sub(first));
            counts.operations += 1;
            let from = (i64::from(cell.x), i64::from(cell.y));
            let (back, end) = (direction.opposite(), taper.end());
            see_back(world, from, &back, end, &mut visible);
            let reached = visible.iter().zip(1..).skip(usize::from(first) - 1);
            let before = counts.additions;
            for (&index, steps) in reached {
                counts.additions += 1;
                add(index, taper.votes(steps));
            }
            counts.operations += u64::from(counts.additions > before);
        }
    }
    counts
}

/// Collects the cells before the nearest obstacle, and before `end` steps.
fn see_back(world: &World, from: (i64, i64), back: &Direction, end: u16, visible: &mut Vec<usize>) {
    visible.clear();
    let (mut x, mut y) = back.advance(from.0, from.1);
    while visible.len() + 1 < usize::from(end) && world.grid.get(x, y) == Some(Cell::Open) {
        visible.push(y as usize * world.grid.width() + x as usize);
        (x, y) = back.advance(x, y);
    }
}

#[cfg(test)]
mod tests {
    use engine::program::ScanProgram;
    use engine::taper::TaperShape;

    use super::*;
    use crate::scans::{ScanConfig, simulate};
    use crate::scatter::Scatter;
    use crate::worlds::Kind;

    const CONFIG: ScanConfig = ScanConfig::new(8, 5.0);

    #[test]
    fn counts_are_the_papers_or_below_and_the_fields_those_of_the_engine() {
        for p_over_n in [0.2, 0.5, 1.2] {
            let world = World::generate(Kind::Rooms, (90, 70), p_over_n, 3).unwrap();
            let space = world.space(72).unwrap();
            let (n, p) = (world.grid.free_cells() as u64, world.boundary.len() as u64);
            let m = CONFIG.beams as u64;
            for scan in simulate(&world, &space, &CONFIG, 3, 5).unwrap() {
                let votes = CONFIG.votes(TaperShape::Trapezoid);
                let program = ScanProgram::new(&scan.scan(), 0.0, &space, &votes).unwrap();
                let readings = Readings::new(&scan.scan(), &space, &votes).unwrap();
                let query = Query {
                    program: &program,
                    space: &space,
                    heading: scan.heading,
                };
                let (_, markov) = markov(&world, &readings, query);
                assert_eq!(markov.operations, n * (2 * m + 1));
                assert_eq!(markov.additions, 2 * m * n);
                let mut field = vec![0; world.grid.cells().len()];
                let mut beams = vec![0; field.len()];
                let reverse = reverse_projection(&world, query, |index, votes| {
                    field[index] += u16::from(votes);
                    beams[index] += 1;
                });
                assert!(reverse.operations <= 2 * m * p);
                assert!(reverse.additions <= reverse.worst_additions);
                assert!(reverse.additions <= m * n, "Theorem 1");
                assert!(beams.iter().all(|&beams| beams <= m), "Lemma 1");
                let scatter = Scatter::new(&world.grid, &world.boundary);
                assert_eq!(field, scatter.field(&program, &space, scan.heading));
            }
        }
    }
}
