//! Bearings of a laser's beams.
//!
//! New lines contain them. For old ones the field of view follows from the log's parameters, or
//! from the number of beams: CARMEN's driver set SICK's lasers to 180° or 100° and 1°, 0.5° or
//! 0.25° (`laser/laser_main.c`), with the last beam missing in older versions of it.

use std::f64::consts::{PI, TAU};

use super::carmen::{Angles, Kind, Laser};
use super::parameters::Mounting;

/// Field of view of old lines if nothing else is known.
pub(super) const HALF_TURN: f64 = PI;

/// Steps agree if they differ by less than this share: parameters have three digits.
const SAME_STEP: f64 = 0.02;

/// Returns the bearing of the first beam and the step between beams, in radians. The step is
/// negative if the line says so.
pub(super) fn of(laser: &Laser, mounting: &Mounting) -> Result<(f64, f64), String> {
    let beams = laser.ranges.len();
    if let Some(angles) = laser.angles {
        return stated(&angles, beams);
    }
    let step_known = mounting.step.unwrap_or(f64::NAN);
    let view = mounting
        .field_of_view
        .unwrap_or_else(|| usual_view(beams, step_known));
    let (full, without_last) = (view / gaps(beams) as f64, view / beams.max(1) as f64);
    let off = |step: f64| (step / step_known - 1.0).abs();
    let nearest = match off(full) < off(without_last) {
        true => full,
        false => without_last,
    };
    // Without a known step, neither is near it.
    let step = match off(nearest) < SAME_STEP {
        true => nearest,
        false => step_over(view, beams),
    };
    let start = -view / 2.0;
    // If the laser looks back but its pose does not say so, its beams are turned instead.
    let is_turned = laser.poses.is_some_and(|poses| {
        geometry::wrap_angle(poses.laser.yaw - poses.robot.yaw).abs() < PI / 4.0
    });
    let turned = match (laser.kind, laser.number) {
        (Kind::Old, 2) if is_turned => PI,
        _ => 0.0,
    };
    Ok((start + turned, step))
}

/// Step of this many beams over a field of view: an odd number of beams includes both ends, an even
/// number lacks the last one.
pub(super) fn step_over(view: f64, beams: usize) -> f64 {
    match beams {
        0 | 1 => view,
        odd if odd % 2 == 1 => view / (odd - 1) as f64,
        even => view / even as f64,
    }
}

fn gaps(beams: usize) -> usize {
    beams.saturating_sub(1).max(1)
}

fn usual_view(beams: usize, step_known: f64) -> f64 {
    let narrow = 100f64.to_radians();
    let is_narrow = match beams {
        400 | 401 => true,
        100 | 101 | 200 | 201 => (step_over(narrow, beams) / step_known - 1.0).abs() < SAME_STEP,
        _ => false,
    };
    if is_narrow { narrow } else { HALF_TURN }
}

fn stated(angles: &Angles, beams: usize) -> Result<(f64, f64), String> {
    let allowed = TAU * (1.0 + 1e-3);
    let spanned = angles.step.abs() * gaps(beams) as f64;
    if angles.step != 0.0 && spanned <= allowed {
        return Ok((angles.start, angles.step));
    }
    // A step of zero, or one that spans too much, is replaced by one from the field of view.
    let view = angles.field_of_view;
    if view > 0.0 && view <= allowed {
        return Ok((angles.start, step_over(view, beams)));
    }
    Err(format!(
        "{beams} beams in steps of {} span {spanned:.2} rad, and the field of view is {view}; \
         allowed: a turn",
        angles.step
    ))
}

#[cfg(test)]
mod tests {
    use std::f64::consts::FRAC_PI_2;

    use geometry::Pose;

    use super::super::carmen::Poses;
    use super::*;

    /// Angles of an old line, in degrees.
    fn angles(beams: usize, view_deg: Option<f64>, step_deg: Option<f64>) -> (f64, f64) {
        let mounting = Mounting {
            field_of_view: view_deg.map(f64::to_radians),
            step: step_deg.map(f64::to_radians),
            ..Mounting::default()
        };
        let (start, step) = of(&Laser::old(1, vec![1.0; beams]), &mounting).unwrap();
        (start.to_degrees(), step.to_degrees())
    }

    fn check(found: (f64, f64), (start, step): (f64, f64)) {
        // Tolerance for sums and quotients of a few terms.
        let is_near = |a: f64, b: f64| (a - b).abs() < 1e-9;
        assert!(
            is_near(found.0, start) && is_near(found.1, step),
            "{found:?} is not {start}, {step}"
        );
    }

    #[test]
    fn old_lines_cover_half_a_turn_or_what_the_driver_sets() {
        check(angles(181, None, None), (-90.0, 1.0));
        check(angles(180, None, None), (-90.0, 1.0));
        check(angles(361, None, None), (-90.0, 0.5));
        check(angles(401, None, None), (-50.0, 0.25));
        check(angles(400, None, None), (-50.0, 0.25));
        check(angles(201, None, Some(0.5)), (-50.0, 0.5));
        // Half a turn of few beams.
        check(angles(201, None, None), (-90.0, 0.9));
        check(angles(181, None, Some(0.5)), (-90.0, 1.0));
    }

    #[test]
    fn parameters_show_the_field_of_view() {
        check(angles(201, Some(100.0), Some(0.5)), (-50.0, 0.5));
        check(angles(200, Some(100.0), Some(0.5)), (-50.0, 0.5));
        check(angles(1081, Some(270.0), None), (-135.0, 0.25));
        check(angles(360, Some(360.0), None), (-180.0, 1.0));
        // The step shows that the last beam is missing.
        check(angles(360, Some(179.5), Some(0.5)), (-89.75, 0.5));
        check(angles(1, Some(100.0), None), (-50.0, 100.0));
        check(angles(0, Some(100.0), None), (-50.0, 100.0));
    }

    #[test]
    fn a_rear_laser_looks_back_by_its_pose_or_by_its_beams() {
        let poses = |yaw| Poses {
            laser: Pose::new(0.0, 0.0, 0.5 + yaw),
            robot: Pose::new(0.0, 0.0, 0.5),
        };
        let start = |number, yaw| {
            let laser = Laser {
                poses: Some(poses(yaw)),
                ..Laser::old(number, vec![1.0; 181])
            };
            of(&laser, &Mounting::default()).unwrap().0
        };
        assert_eq!(start(2, 0.0), FRAC_PI_2);
        assert_eq!(start(2, PI), -FRAC_PI_2);
        assert_eq!(start(1, 0.0), -FRAC_PI_2);
    }

    #[test]
    fn new_lines_say_their_angles() {
        let of = |start, field_of_view, step| {
            let angles = Angles {
                start,
                field_of_view,
                step,
            };
            stated(&angles, 181)
        };
        let degree = 1f64.to_radians();
        assert_eq!(of(-1.0, PI, degree), Ok((-1.0, degree)));
        assert_eq!(of(1.0, PI, -degree), Ok((1.0, -degree)));
        assert_eq!(of(-1.0, PI, 0.0), Ok((-1.0, degree)));
        assert_eq!(of(-1.0, PI, 1.0), Ok((-1.0, degree)));
        assert_eq!(
            of(-90.0, 180.0, 1.0).unwrap_err(),
            "181 beams in steps of 1 span 180.00 rad, and the field of view is 180; allowed: a turn"
        );
    }
}
