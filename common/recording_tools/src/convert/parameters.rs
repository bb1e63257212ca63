//! Settings of the lasers from a log's parameters.
//!
//! CARMEN's own names are `laser_front_laser_fov`, `laser_rear_laser_fov`, `laser_laser3_fov`, and
//! so on with `_flipped` and `_resolution`, and `robot_frontlaser_offset`, `_side_offset` and
//! `_angular_offset` (`laser/laser_main.c`, `robot/robot_main.c`); similar spellings occur and are
//! accepted as well. Angles were radians in some versions and degrees in others.

use std::f64::consts::{PI, TAU};

use geometry::Pose;

use super::carmen::Parameter;

/// A field of view above this is in degrees, because it exceeds a full turn in radians.
const MAX_RADIANS: f64 = TAU + 0.01;

/// A step above this is in degrees: 0.05 rad is three of them.
const MAX_STEP_RADIANS: f64 = 0.05;

/// Settings of one laser; angles in radians.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Mounting {
    pub(super) field_of_view: Option<f64>,
    pub(super) step: Option<f64>,
    /// Parameter that marks it as upside down.
    pub(super) flipped: Option<String>,
    pub(super) forward_m: Option<f64>,
    pub(super) left_m: Option<f64>,
    pub(super) turned: Option<f64>,
}

/// Settings of lasers 1 to 5.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Parameters([Mounting; 5]);

impl Parameters {
    pub(super) fn of(&self, number: u8) -> &Mounting {
        let index = usize::from(number).saturating_sub(1);
        // Lasers are numbered 1 to 5.
        &self.0[index.min(self.0.len() - 1)]
    }

    /// Adds a parameter; if it is repeated, the first value counts.
    pub(super) fn note(&mut self, parameter: &Parameter) {
        let name = parameter.name.to_ascii_lowercase();
        let Some(number) = laser_of(&name) else {
            return;
        };
        let Some(mounting) = self.0.get_mut(usize::from(number) - 1) else {
            return;
        };
        let is_positive = |value: &f64| *value > 0.0;
        let number = parameter.value.parse().ok().filter(|v: &f64| v.is_finite());
        let ends = |endings: &[&str]| endings.iter().any(|ending| name.ends_with(ending));
        let (slot, value) = if ends(&["_flipped", "_flip", "_upside_down"]) {
            if is_on(&parameter.value) && mounting.flipped.is_none() {
                mounting.flipped = Some(parameter.name.clone());
            }
            return;
        } else if ends(&["_fov", "_field_of_view"]) {
            let view = number.map(|view| radians(view, MAX_RADIANS));
            let is_view = |view: &f64| *view <= MAX_RADIANS;
            (
                &mut mounting.field_of_view,
                view.filter(is_positive).filter(is_view),
            )
        } else if ends(&["_resolution"]) {
            let step = number.map(|step| radians(step, MAX_STEP_RADIANS));
            (&mut mounting.step, step.filter(is_positive))
        } else if ends(&["_side_offset"]) {
            (&mut mounting.left_m, number)
        } else if ends(&["_angular_offset"]) {
            let turned = number.map(|angle| radians(angle, MAX_RADIANS));
            (&mut mounting.turned, turned)
        } else if ends(&["laser_offset"]) {
            (&mut mounting.forward_m, number)
        } else {
            return;
        };
        if slot.is_none() {
            *slot = value;
        }
    }
}

impl Mounting {
    /// Mount of laser `number` on the robot, if any part of it is given. A rear laser looks back by
    /// default.
    pub(super) fn base_from_laser(&self, number: u8) -> Option<Pose> {
        self.forward_m.or(self.left_m).or(self.turned)?;
        let usual = if number == 2 { PI } else { 0.0 };
        Some(Pose::new(
            self.forward_m.unwrap_or(0.0),
            self.left_m.unwrap_or(0.0),
            self.turned.unwrap_or(usual),
        ))
    }
}

fn laser_of(name: &str) -> Option<u8> {
    if !(name.starts_with("laser_") || name.starts_with("robot_")) {
        return None;
    }
    if name.contains("front_laser") || name.contains("frontlaser") {
        return Some(1);
    }
    if name.contains("rear_laser") || name.contains("rearlaser") {
        return Some(2);
    }
    let digit = name
        .split("laser")
        .find_map(|after| after.chars().next()?.to_digit(10));
    digit
        .and_then(|digit| u8::try_from(digit).ok())
        .filter(|digit| (1..=5).contains(digit))
}

fn radians(value: f64, most: f64) -> f64 {
    if value.abs() > most {
        value.to_radians()
    } else {
        value
    }
}

fn is_on(value: &str) -> bool {
    let is_number = |number: f64| number.is_finite() && number != 0.0;
    matches!(value.to_ascii_lowercase().as_str(), "on" | "true" | "yes")
        || value.parse().is_ok_and(is_number)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parameters(pairs: &[(&str, &str)]) -> Parameters {
        let mut parameters = Parameters::default();
        for (name, value) in pairs {
            parameters.note(&Parameter {
                name: (*name).to_owned(),
                value: (*value).to_owned(),
            });
        }
        parameters
    }

    #[test]
    fn the_field_of_view_is_in_radians_or_degrees() {
        for (name, value, number, degrees) in [
            ("laser_front_laser_fov", "180", 1, 180.0),
            ("laser_front_laser_fov", "3.141592653589793", 1, 180.0),
            ("laser_rear_laser_fov", "100.0", 2, 100.0),
            ("laser_laser1_fov", "270", 1, 270.0),
            ("laser_laser5_fov", "240", 5, 240.0),
            ("robot_frontlaser_fov", "360", 1, 360.0),
        ] {
            let parameters = parameters(&[(name, value)]);
            let view = parameters.of(number).field_of_view.unwrap().to_degrees();
            // Tolerance for radians of sixteen digits, converted to degrees and back.
            assert!((view - degrees).abs() < 1e-9, "{name} {value} is {view}");
        }
        for (name, value) in [
            ("laser_front_laser_fov", "0"),
            ("laser_front_laser_fov", "nan"),
            ("laser_front_laser_fov", "3600"),
            ("simulator_frontlaser_fov", "90"),
            ("laser_num_laser_devices", "2"),
            ("laser_laser6_fov", "180"),
            ("robot_length", "1"),
        ] {
            assert_eq!(
                parameters(&[(name, value)]),
                Parameters::default(),
                "{name}"
            );
        }
    }

    #[test]
    fn steps_flips_and_mounts() {
        let all = parameters(&[
            ("laser_front_laser_resolution", "0.5"),
            ("laser_front_laser_flipped", "1"),
            ("laser_front_laser_flipped", "0"),
            ("robot_frontlaser_offset", "0.78"),
            ("robot_frontlaser_side_offset", "-0.1"),
            ("robot_rearlaser_offset", "-0.3"),
            ("laser_rear_laser_flipped", "0"),
            ("laser_laser3_resolution", "0.008727"),
            ("laser_laser3_flipped", "on"),
            ("robot_rearlaser_angular_offset", "3"),
        ]);
        let front = all.of(1);
        assert_eq!(front.step, Some(0.5f64.to_radians()));
        assert_eq!(front.flipped.as_deref(), Some("laser_front_laser_flipped"));
        assert_eq!(front.base_from_laser(1), Some(Pose::new(0.78, -0.1, 0.0)));
        assert_eq!(all.of(2).flipped, None);
        assert_eq!(
            all.of(2).base_from_laser(2),
            Some(Pose::new(-0.3, 0.0, 3.0))
        );
        assert_eq!(all.of(3).step, Some(0.008727));
        assert!(all.of(3).flipped.is_some());
        assert_eq!(all.of(3).base_from_laser(3), None);
        let rear = parameters(&[("robot_rearlaser_offset", "-0.3")]);
        assert_eq!(
            rear.of(2).base_from_laser(2),
            Some(Pose::new(-0.3, 0.0, PI))
        );
    }
}
