//! Uniform start of the particles over all free cells.

use std::f64::consts::TAU;

use geometry::wrap_angle;
use rand::RngExt;

use engine::EngineError;
use engine::fit::{DistanceField, GridPose};
use engine::particles::Rng;

/// Headings of the particles at the start.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum StartHeadings<'a> {
    /// Uniform over a turn.
    Any,
    /// One of these, radians in the map, with equal probability.
    OneOf(&'a [f64]),
}

impl StartHeadings<'_> {
    fn check(self) -> Result<(), EngineError> {
        let StartHeadings::OneOf(headings) = self else {
            return Ok(());
        };
        match headings.iter().find(|heading| !heading.is_finite()) {
            Some(&heading) => Err(EngineError::Heading(heading)),
            None if headings.is_empty() => Err(EngineError::NoStart),
            None => Ok(()),
        }
    }
}

/// Draws poses, uniform over the free cells of a map. Unknown cells are not free.
pub(super) struct Uniform<'a> {
    width: usize,
    free: Vec<u32>,
    headings: StartHeadings<'a>,
    turn: f64,
}

impl<'a> Uniform<'a> {
    pub(super) fn new(
        distance_field: &DistanceField,
        headings: StartHeadings<'a>,
    ) -> Result<Self, EngineError> {
        let free: Vec<u32> = distance_field
            .free_cells()
            .map(|cell| cell as u32)
            .collect();
        if free.is_empty() {
            return Err(EngineError::NoFreeCell);
        }
        headings.check()?;
        Ok(Uniform {
            width: distance_field.width(),
            free,
            headings,
            turn: distance_field.frame.map_from_grid.yaw,
        })
    }

    pub(super) fn draw(&self, rng: &mut Rng) -> GridPose {
        let cell = *one_of(&self.free, rng) as usize;
        let (within_x, within_y): (f64, f64) = (rng.random(), rng.random());
        GridPose {
            x: (cell % self.width) as f64 + within_x,
            y: (cell / self.width) as f64 + within_y,
            heading: match self.headings {
                StartHeadings::Any => TAU * rng.random::<f64>(),
                StartHeadings::OneOf(headings) => wrap_angle(one_of(headings, rng) - self.turn),
            },
        }
    }
}

fn one_of<'a, T>(items: &'a [T], rng: &mut Rng) -> &'a T {
    &items[rng.random_range(0..items.len() as u64) as usize]
}

#[cfg(test)]
mod tests {
    use rand::SeedableRng;

    use super::super::drawn::distance_field;
    use super::*;

    #[test]
    fn particles_start_in_every_free_cell_and_in_no_other() {
        let distance_field = distance_field(&["#.?", "..#"]);
        let uniform = Uniform::new(&distance_field, StartHeadings::OneOf(&[1.0, 4.0])).unwrap();
        let mut rng = Rng::seed_from_u64(1);
        let mut counts = [0; 6];
        for _ in 0..3000 {
            let GridPose { x, y, heading } = uniform.draw(&mut rng);
            counts[y as usize * 3 + x as usize] += 1;
            assert!(heading == 1.0 || heading == wrap_angle(4.0));
        }
        // 1000 each, with a standard deviation of 26: within four of those.
        for (cell, count) in counts.into_iter().enumerate() {
            let expected = if [0, 1, 4].contains(&cell) {
                1000i32
            } else {
                0
            };
            assert!((count - expected).abs() <= 104, "{counts:?}");
        }
    }

    #[test]
    fn a_map_without_free_cells_has_no_start() {
        let refused = Uniform::new(&distance_field(&["#?"]), StartHeadings::Any);
        assert_eq!(refused.err(), Some(EngineError::NoFreeCell));
    }
}
