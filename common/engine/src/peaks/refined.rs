//! Places that candidates are refined to, with their covariances.

use geometry::{Covariance, wrap_angle};
use nalgebra::{Matrix3, Vector3};

use super::summits::Summit;
use super::{PeakConfig, PeakInput, Place, in_map};
use crate::fit::{DistanceField, Ends, GridPose, Refined};

/// Refines a candidate to a place; its score is an upper bound.
pub(super) fn place(
    input: &PeakInput<'_>,
    (distance_field, ends): (&DistanceField, &Ends),
    summit: &Summit,
    config: &PeakConfig,
) -> Place {
    let vote = &summit.vote;
    let side = input.frame.resolution_m / distance_field.frame.resolution_m;
    let start = GridPose {
        x: side * (f64::from(vote.x) + 0.5),
        y: side * (f64::from(vote.y) + 0.5),
        heading: input
            .known_heading_in_grid()
            .unwrap_or(input.heading_of(vote)),
    };
    let is_known = input.known_heading.is_some();
    let refined = distance_field.refine(ends, start, is_known, &config.fit);
    let pose = refined.pose;
    let mut map_from_laser = distance_field
        .frame
        .map_from_cells(pose.x, pose.y, pose.heading);
    if let Some(heading) = input.known_heading {
        map_from_laser.yaw = wrap_angle(heading);
    }
    Place {
        map: 0,
        map_from_laser,
        covariance: covariance(distance_field, is_known, &refined),
        score: distance_field.score_at_most(ends, pose, &config.fit),
        probability: 0.0,
        intensity: vote.intensity,
        possible: input.highest_possible as u16,
        drawn_doubt: distance_field.drawn_doubt(&config.fit),
        support: summit.support,
    }
}

/// Standard deviations of a place along directions that no beam constrains, in metres and radians.
const LOOSE_M: f64 = 2.0;
const LOOSE_RADIANS: f64 = 0.35;

/// Covariance of a refined pose in the map frame, from the curvature of the fit and the errors of
/// walls.
fn covariance(
    distance_field: &DistanceField,
    heading_is_known: bool,
    refined: &Refined,
) -> Covariance {
    let loose = LOOSE_M / distance_field.frame.resolution_m;
    let prior = Vector3::new(loose.powi(-2), loose.powi(-2), LOOSE_RADIANS.powi(-2));
    let mut information = refined.information() + Matrix3::from_diagonal(&prior);
    if heading_is_known {
        // The heading has no error, and x and y have none from it.
        information.fill_row(2, 0.0);
        information.fill_column(2, 0.0);
        information[(2, 2)] = 1.0;
    }
    // The prior makes it positive definite.
    let mut in_cells = information.try_inverse().unwrap_or_else(Matrix3::zeros);
    if heading_is_known {
        in_cells[(2, 2)] = 0.0;
    }
    let drawn = distance_field.drawn_error_m() / distance_field.frame.resolution_m;
    in_cells += refined.by_walls(in_cells, drawn);
    in_map(distance_field.frame, in_cells)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fit::drawn::distance_field;

    fn deviations(heading_is_known: bool, curvature: Matrix3<f64>) -> [f64; 3] {
        let measured = distance_field(&["....", ".##.", "#..#"]);
        let refined = Refined {
            pose: GridPose::new(0.0, 0.0, 0.0),
            curvature,
            variance: 0.5,
            weight: 100.0,
            walls: Matrix3::zeros(),
        };
        let covariance = covariance(&measured, heading_is_known, &refined).to_rows();
        [0, 4, 8].map(|i| covariance[i].sqrt())
    }

    #[test]
    fn a_known_heading_does_not_err_nor_the_position_with_it() {
        // Turning moves all ends like a motion of 20 cells along y.
        let turned = Matrix3::new(50.0, 0.0, 0.0, 0.0, 50.0, 900.0, 0.0, 900.0, 20_000.0);
        let [x, y, yaw] = deviations(false, turned);
        let [known_x, known_y, known_yaw] = deviations(true, turned);
        assert!(
            (x - known_x).abs() < 1e-9 && known_y < 0.7 * y,
            "{y} {known_y}"
        );
        assert!(yaw > 0.0 && known_yaw == 0.0);
        // Eight beams are worth one: 0.5 · 8 / 50 squared cells.
        assert!((known_x - 0.1 * 0.08f64.sqrt()).abs() < 1e-4, "{known_x}");
    }

    #[test]
    fn along_what_no_beam_shows_a_place_is_two_metres_long() {
        let corridor = Matrix3::from_diagonal(&Vector3::new(0.0, 90.0, 5_000.0));
        let [x, y, _] = deviations(false, corridor);
        assert!((x - LOOSE_M).abs() < 1e-9 && y < 0.03, "{x} {y}");
    }
}
