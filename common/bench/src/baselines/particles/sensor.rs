//! Likelihood of a scan for a particle: the likelihood field model of Probabilistic Robotics,
//! section 6.4.
//!
//! Only ratios of weights matter, so each likelihood is a share of that of a reading that fits
//! exactly: the parts of the model are scaled to a maximum of 1 in place of the book's densities
//! (as in AMCL). Other differences from the book:
//!
//! - Beams without a return are ignored, since the range below which they would have returned is
//!   not known; table 6.1 gives them a separate share.
//! - Beams count as a few independent ones: the likelihood is raised to a power below 1, as
//!   section 6.3.4 advises.
//! - A pose off the map or in an obstacle explains no reading.

use engine::fit::{DistanceField, GridPose};

/// Likelihood of a reading that does not fit the map, as a share of one that does.
const RANDOM: f64 = 0.05;

/// Number of independent beams that all count for: neighbours end on the same wall.
const INDEPENDENT: f64 = 16.0;

/// Steps per standard deviation in the table: the likelihood differs by less than 2 %.
const STEPS: f64 = 32.0;

/// Standard deviations beyond which a reading does not fit at all: 3 · 10⁻⁴ of the maximum
/// likelihood, less than any random share.
const REACH: f64 = 4.0;

pub(in super::super) struct Sensor {
    /// End points in cells of the target frame.
    ends: Vec<(f64, f64)>,
    /// Exponent of each beam's likelihood.
    weight: f64,
    /// Log-likelihood of an end point at each [`STEPS`]th of a standard deviation from the nearest
    /// obstacle; the last one is for all larger distances.
    field: Vec<f64>,
    /// Table steps per cell of distance.
    steps_per_cell: f64,
}

impl Sensor {
    /// `beams` are bearings in radians and ranges in cells. The standard deviation of an end point is
    /// at least one cell, to which end points are rounded.
    pub(in super::super) fn new(
        beams: impl IntoIterator<Item = (f64, f64)>,
        sigma_cells: f64,
    ) -> Self {
        let end = |(bearing, cells): (f64, f64)| (cells * bearing.cos(), cells * bearing.sin());
        let ends: Vec<_> = beams.into_iter().map(end).collect();
        let near = (0..(REACH * STEPS) as usize).map(|step| {
            let deviations = step as f64 / STEPS;
            let hit = (-0.5 * deviations * deviations).exp();
            (RANDOM + (1.0 - RANDOM) * hit).ln()
        });
        Sensor {
            weight: (INDEPENDENT / ends.len().max(1) as f64).min(1.0),
            ends,
            field: near.chain([RANDOM.ln()]).collect(),
            steps_per_cell: STEPS / sigma_cells.max(1.0),
        }
    }

    /// Log-likelihood of the beams at a pose, at most 0.
    pub(super) fn log_likelihood(&self, distance_field: &DistanceField, pose: GridPose) -> f64 {
        let stands = distance_field.cell_distance(pose.x, pose.y);
        if stands.is_none_or(|distance| distance == 0.0) {
            return self.weight * self.ends.len() as f64 * RANDOM.ln();
        }
        let (sin, cos) = pose.heading.sin_cos();
        let far = self.field.len() - 1;
        // By the nearest obstacle of the end point (table 6.3). The distance is that of the cell, up
        // to 0.7 cells off: one look-up, where the exact distance needs four.
        let of_beam = |&(x, y): &(f64, f64)| {
            let (x, y) = (x * cos - y * sin, x * sin + y * cos);
            let distance = distance_field.cell_distance(pose.x + x, pose.y + y);
            let step = distance.map_or(far, |cells| {
                (f64::from(cells) * self.steps_per_cell) as usize
            });
            self.field[step.min(far)]
        };
        self.weight * self.ends.iter().map(of_beam).sum::<f64>()
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::distance_field;
    use super::*;

    /// A wall at 8 cells.
    const MAP: [&str; 5] = [
        "............",
        "............",
        "........#...",
        "............",
        "............",
    ];

    #[test]
    fn an_end_point_at_a_wall_is_likely_and_one_in_the_open_is_not() {
        let away = |deviations: f64| 0.05 + 0.95 * (-0.5 * deviations * deviations).exp();
        for (x, y, cells, expected) in [
            (0.5, 2.5, 8.0, 1.0),
            // One and two standard deviations of two cells before and behind the wall, and far away.
            (0.5, 2.5, 6.0, away(1.0)),
            (0.5, 2.5, 10.0, away(1.0)),
            (0.5, 2.5, 4.0, away(2.0)),
            (0.5, 2.5, 0.0, 0.05),
            (0.5, 2.5, 30.0, 0.05),
            // In an obstacle, and off the map.
            (8.5, 2.5, 8.0, 0.05),
            (-1.0, 2.5, 8.0, 0.05),
            (3.0, 5.1, 8.0, 0.05),
        ] {
            let pose = GridPose { x, y, heading: 0.0 };
            let sensor = Sensor::new([(0.0, cells)], 2.0);
            let likelihood = sensor.log_likelihood(&distance_field(&MAP), pose).exp();
            assert!(
                (likelihood - expected).abs() < 1e-9,
                "{pose:?} {cells}: {likelihood}"
            );
        }
        let many = Sensor::new([(0.0, 8.0); 32], 2.0);
        assert_eq!(many.weight, 0.5, "they count as 16");
    }
}
