//! Markov localization with precomputed ranges, after Fox, Burgard and Thrun (the paper's [1]).

use engine::grid::Cell;
use engine::instruction_set::InstructionSet;
use engine::space::Space;

use super::Baseline;
use super::best::{Best, Estimate};
use super::reading::{Expected, Readings};
use crate::worlds::World;

/// Number of cells scored together: their ranges in 360 directions fit the L2 cache.
const TILE: usize = 1024;

/// Range without an obstacle along the ray.
const NO_RANGE: u16 = u16::MAX;

/// Markov localization with a table of ranges, two bytes for each cell and direction.
#[derive(Debug, Clone)]
pub struct RangeTable {
    space: Space,
    width: usize,
    /// Range of each cell in steps, direction by direction.
    ranges: Vec<u16>,
    /// Zero for free cells, infinite for others.
    blocked: Vec<f32>,
    instructions: InstructionSet,
}

impl RangeTable {
    pub fn new(world: &World, space: &Space) -> Self {
        let cells = world.grid.cells();
        let blocked = |&cell: &Cell| match cell {
            Cell::Open => 0.0,
            _ => f32::INFINITY,
        };
        let mut table = RangeTable {
            space: space.clone(),
            width: world.grid.width(),
            ranges: Vec::new(),
            blocked: cells.iter().map(blocked).collect(),
            instructions: InstructionSet::best(),
        };
        (0..space.directions.count()).for_each(|direction| table.push(world, direction));
        table
    }

    /// The range of a cell is one step more than that of the next cell on its line.
    fn push(&mut self, world: &World, direction: usize) {
        let grid = &world.grid;
        let (width, height) = (grid.width(), grid.height());
        let direction = self.space.directions.get(direction);
        let start = self.ranges.len();
        self.ranges.resize(start + width * height, NO_RANGE);
        let ranges = &mut self.ranges[start..];
        let (majors, minors, major_stride, minor_stride) = match direction.x_major {
            true => (width, height, 1, width),
            false => (height, width, width, 1),
        };
        for i in 0..majors {
            let major = if direction.step > 0 {
                majors - 1 - i
            } else {
                i
            };
            for minor in 0..minors {
                let at = major * major_stride + minor * minor_stride;
                let (x, y) = (at % width, at / width);
                let next = direction.advance(x as i64, y as i64);
                ranges[at] = match (grid.cells()[at], grid.get(next.0, next.1)) {
                    (Cell::Occupied, _) => 0,
                    (Cell::Open, Some(_)) => {
                        ranges[next.1 as usize * width + next.0 as usize].saturating_add(1)
                    }
                    _ => NO_RANGE,
                };
            }
        }
    }

    /// Ranges of all cells in a direction, row by row.
    fn ranges(&self, direction: usize) -> &[u16] {
        let cells = self.blocked.len();
        &self.ranges[direction * cells..][..cells]
    }

    /// Scores one tile at one heading; lower is better.
    fn score(&self, tile: usize, readings: &Readings, heading: usize, costs: &mut [f32]) {
        let count = self.space.directions.count();
        let len = costs.len();
        costs.copy_from_slice(&self.blocked[tile..][..len]);
        for reading in &readings.beams {
            let direction = (heading + reading.bearing) % count;
            let steps_per_cell = self.space.directions.get(direction).steps_per_cell;
            let ranges = &self.ranges(direction)[tile..][..len];
            let expected = reading.along(steps_per_cell);
            add(self.instructions, expected, ranges, costs);
        }
    }
}

impl Baseline for RangeTable {
    fn locate(&mut self, readings: &Readings, headings: &[usize]) -> Option<Estimate> {
        let mut best = Best::default();
        let mut costs = [0.0; TILE];
        for tile in (0..self.blocked.len()).step_by(TILE) {
            let costs = &mut costs[..TILE.min(self.blocked.len() - tile)];
            for &heading in headings {
                self.score(tile, readings, heading, costs);
                for (i, &cost) in (tile..).zip(costs.iter()) {
                    if -cost >= best.score() && cost.is_finite() {
                        let (x, y) = (i % self.width, i / self.width);
                        best.take(Estimate::new(x, y, heading, -cost));
                    }
                }
            }
        }
        best.get()
    }

    fn bytes(&self) -> usize {
        size_of_val(&self.ranges[..]) + size_of_val(&self.blocked[..])
    }
}

/// Adds the penalty of one reading over many ranges.
fn add(instructions: InstructionSet, expected: Expected, ranges: &[u16], costs: &mut [f32]) {
    match instructions {
        #[cfg(target_arch = "x86_64")]
        // SAFETY: the processor has what was detected.
        InstructionSet::Avx2 => unsafe { add_avx2(expected, ranges, costs) },
        _ => add_plain(expected, ranges, costs),
    }
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2")]
fn add_avx2(expected: Expected, ranges: &[u16], costs: &mut [f32]) {
    add_plain(expected, ranges, costs);
}

/// Compiled separately for each instruction set.
#[inline(always)]
fn add_plain(expected: Expected, ranges: &[u16], costs: &mut [f32]) {
    for (cost, &range) in costs.iter_mut().zip(ranges) {
        *cost += expected.penalty(f32::from(range));
    }
}

#[cfg(test)]
mod tests {
    use engine::reference;

    use super::super::RayCasting;
    use super::super::tests::noisy;
    use super::*;

    #[test]
    fn the_table_holds_what_rays_meet() {
        let (world, space, _) = noisy(40, 20);
        let table = RangeTable::new(&world, &space);
        for d in 0..40 {
            for (i, &range) in table.ranges(d).iter().enumerate() {
                let (x, y) = ((i % 90) as i64, (i / 90) as i64);
                let plain = reference::range(&world.grid, x, y, space.directions.get(d));
                assert_eq!(range, plain.unwrap_or(NO_RANGE));
            }
        }
    }

    #[test]
    fn it_finds_what_ray_casts_find_on_every_instruction_set() {
        let (world, space, scans) = noisy(40, 20);
        let mut casts = RayCasting::new(&world, &space);
        let mut table = RangeTable::new(&world, &space);
        let headings: Vec<usize> = (0..40).collect();
        for readings in scans {
            let plain = casts.locate(&readings, &headings);
            for set in InstructionSet::available() {
                table.instructions = set;
                assert_eq!(table.locate(&readings, &headings), plain, "{set}");
            }
        }
    }
}
