//! The paper's method as written, for a ring of rangefinders at a known heading: Eq. 1
//! by projection from the boundary cells, its Gaussian over the bearing included where
//! one is asked for.

use crate::scatter::Scatter;
use crate::worlds::World;
use engine::program::{ScanProgram, VoteConfig};
use engine::scan::Scan;
use engine::space::Space;

/// Beyond this many deviations the Gaussian over the bearing is left out.
const DEVIATIONS: f64 = 2.5;

#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Projection {
    /// The taper over the range, and its deviation.
    pub(super) votes: VoteConfig,
    /// σ_θ of Eq. 1, degrees; 0 leaves it out, as the paper does.
    pub(super) bearing_sigma_deg: f64,
}

/// Intensity of each cell at a heading of the grid, row by row from the lowest y, in votes.
pub(super) fn intensities(
    (world, space): (&World, &Space),
    scan: &Scan<'_>,
    heading: usize,
    projection: &Projection,
) -> anyhow::Result<Vec<f64>> {
    let sigma = projection.bearing_sigma_deg;
    let most = (DEVIATIONS * sigma).floor() as i32;
    let mut sums = vec![0.0; world.grid.cells().len()];
    for degrees in -most..=most {
        let turn = f64::from(degrees).to_radians();
        let program = ScanProgram::new(scan, turn, space, &projection.votes)?;
        let field = Scatter::new(&world.grid, &world.boundary).field(&program, space, heading);
        let weight = match degrees {
            0 => 1.0,
            _ => (-0.5 * (f64::from(degrees) / sigma).powi(2)).exp(),
        };
        for (sum, &votes) in sums.iter_mut().zip(&field) {
            *sum += weight * f64::from(votes);
        }
    }
    Ok(sums)
}

/// The cell with the highest intensity, of equal ones the first; column and row.
pub(super) fn best_cell(intensities: &[f64], width: usize) -> Option<(usize, usize)> {
    let all = intensities.iter().enumerate().rev();
    let (best, &most) = all.max_by(|a, b| a.1.total_cmp(b.1))?;
    (most > 0.0).then_some((best % width, best / width))
}

#[cfg(test)]
mod tests {
    use crate::scans::{RingConfig, simulate_ring};
    use crate::worlds::Kind;
    use engine::taper::TaperShape;

    use super::*;

    #[test]
    fn exact_readings_put_the_peak_on_the_robot_with_and_without_a_bearing_error() {
        let world = World::generate(Kind::Rooms, (90, 80), 0.12, 2).unwrap();
        let space = world.space(360).unwrap();
        let ring = RingConfig {
            bearings_deg: &simulation::TRANSDUCERS_DEG,
            noise_percent: 0.0,
            bearing_sigma_deg: 0.0,
        };
        for bearing_sigma_deg in [0.0, 1.0] {
            let projection = Projection {
                votes: ring.votes(TaperShape::Gaussian),
                bearing_sigma_deg,
            };
            for scan in simulate_ring(&world, &space, &ring, 5, 1).unwrap() {
                let here = (&world, &space);
                let field = intensities(here, &scan.scan(), scan.heading, &projection).unwrap();
                let best = field.iter().copied().fold(0.0, f64::max);
                let there = field[scan.y * world.grid.width() + scan.x];
                // Neighbours may be as good where turned rays meet other cells.
                assert!(there >= 0.9 * best, "{there} {best}");
            }
        }
    }

    #[test]
    fn of_equal_cells_the_first_is_best() {
        assert_eq!(best_cell(&[0.0, 2.0, 1.0, 2.0], 2), Some((1, 0)));
        assert_eq!(best_cell(&[0.0; 4], 2), None);
    }
}
