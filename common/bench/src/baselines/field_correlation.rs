//! Correlation with a likelihood field: scores the distance of each beam's end point to the nearest
//! obstacle (Thrun, Burgard and Fox, Probabilistic Robotics, section 6.4). It ignores obstacles
//! along the beam.

use engine::fit::distance;
use engine::space::Space;

use super::Baseline;
use super::best::Estimate;
use super::correlation::{Correlation, Together};
use super::reading::Readings;
use crate::worlds::World;

/// Likelihood of an end point at an obstacle: four bits, the resolution of the engine's votes.
const FULL: u8 = 15;

/// Number of rows whose sum fits eight bits.
const TOGETHER: usize = (u8::MAX / FULL) as usize;

#[derive(Debug, Clone)]
pub struct FieldCorrelation(Correlation);

impl FieldCorrelation {
    /// Prepares a map for readings with one standard deviation, in cells.
    pub fn new(world: &World, space: &Space, sigma_cells: f64) -> Self {
        let field = likelihood(world, sigma_cells);
        FieldCorrelation(Correlation::new(world, space, field))
    }
}

impl Baseline for FieldCorrelation {
    fn locate(&mut self, readings: &Readings, headings: &[usize]) -> Option<Estimate> {
        self.0.best(headings, |heading| {
            let ends = end_points(readings, &self.0.space, heading);
            let together = |cells: &[(i32, i32)]| Together {
                cells: cells.to_vec(),
                weight: 1,
            };
            ends.chunks(TOGETHER).map(together).collect()
        })
    }

    fn bytes(&self) -> usize {
        self.0.bytes()
    }
}

/// End points of the beams at one heading, in cells from the laser.
fn end_points(readings: &Readings, space: &Space, heading: usize) -> Vec<(i32, i32)> {
    let end = |reading: &super::Reading| {
        let angle = (heading + reading.bearing) as f64 * space.directions.spacing();
        let (sin, cos) = angle.sin_cos();
        let cells = |part: f64| (reading.cells * part).round() as i32;
        (cells(cos), cells(sin))
    };
    readings.beams.iter().map(end).collect()
}

/// Likelihood of an end point in each cell, up to [`FULL`].
fn likelihood(world: &World, sigma_cells: f64) -> Vec<u8> {
    // Beyond this distance the likelihood rounds to zero.
    let most = (0..)
        .find(|&square: &u32| level(square, sigma_cells) == 0)
        .unwrap_or(u32::MAX);
    let levels: Vec<u8> = (0..=most).map(|it| level(it, sigma_cells)).collect();
    let at = |square: u32| levels[square.min(most) as usize];
    square_distances(world).map(at).collect()
}

fn level(square: u32, sigma_cells: f64) -> u8 {
    let height = (-0.5 * f64::from(square) / (sigma_cells * sigma_cells)).exp();
    (f64::from(FULL) * height).round() as u8
}

/// Squared distance of each cell to the nearest boundary cell: no beam ends inside obstacles.
fn square_distances(world: &World) -> impl Iterator<Item = u32> {
    let (width, height) = (world.grid.width(), world.grid.height());
    let is_boundary = world.is_boundary();
    let distances = distance::transform(width, height, |i| is_boundary[i]);
    // Squares that matter are small, so that rounding restores them exactly.
    let square = |distance: f32| (distance * distance).round() as u32;
    distances.into_iter().map(square)
}

#[cfg(test)]
mod tests {
    use engine::instruction_set::InstructionSet;

    use super::super::tests::{best_of, noisy};
    use super::*;
    use crate::worlds::Kind;

    #[test]
    fn distances_are_those_to_the_nearest_boundary_cell() {
        let world = World::generate(Kind::Boxes, (40, 30), 0.25, 1).unwrap();
        let places = world.boundary.iter();
        let boundary: Vec<usize> = places
            .map(|cell| usize::from(cell.y) * 40 + usize::from(cell.x))
            .collect();
        for (i, distance) in square_distances(&world).enumerate() {
            let square = |a: usize, b: usize| a.abs_diff(b).pow(2);
            let to = |&j: &usize| square(i % 40, j % 40) + square(i / 40, j / 40);
            assert_eq!(Some(distance as usize), boundary.iter().map(to).min());
        }
    }

    #[test]
    fn the_best_pose_is_that_of_plain_sums_on_every_instruction_set() {
        let (world, space, scans) = noisy(24, 24);
        let field = likelihood(&world, 2.0);
        let mut correlation = FieldCorrelation::new(&world, &space, 2.0);
        let headings: Vec<usize> = (0..24).collect();
        for readings in scans {
            let plain = best_of(&world, |heading| {
                let ends = end_points(&readings, &space, heading);
                let field = &field;
                move |x, y| {
                    let ends = ends
                        .iter()
                        .map(|&(dx, dy)| (x + i64::from(dx), y + i64::from(dy)));
                    let inside = ends.filter(|(x, y)| (0..90).contains(x) && (0..70).contains(y));
                    inside
                        .map(|(x, y)| u16::from(field[(y * 90 + x) as usize]))
                        .sum()
                }
            });
            for set in InstructionSet::available() {
                correlation.0.instructions = set;
                assert_eq!(correlation.locate(&readings, &headings), plain, "{set}");
            }
        }
    }
}
