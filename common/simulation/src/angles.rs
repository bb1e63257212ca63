//! The bearings of a scan, as a message states them.

use std::f64::consts::TAU;

/// Evenly spaced bearings. They are kept in the 32 bits of a `LaserScan`, and
/// rays are cast along what those say.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bearings {
    /// The first, radians counter-clockwise from ahead.
    pub angle_min: f32,
    /// From one to the next, radians.
    pub angle_increment: f32,
    /// How many, at least two.
    pub count: usize,
}

impl Bearings {
    /// Bearings over a field of view whose middle is ahead; over a whole turn
    /// the last one is a step before the first.
    #[must_use]
    pub fn over(field_of_view: f64, count: usize) -> Self {
        // A thousandth of a step below a turn is a turn that was rounded.
        let is_turn = field_of_view > TAU * (1.0 - 1e-3 / count as f64);
        let steps = if is_turn { count } else { count - 1 };
        Bearings {
            angle_min: (-field_of_view / 2.0) as f32,
            angle_increment: (field_of_view / steps as f64) as f32,
            count,
        }
    }

    /// Bearing `i`, radians.
    #[must_use]
    pub fn get(&self, i: usize) -> f64 {
        f64::from(self.angle_min) + i as f64 * f64::from(self.angle_increment)
    }

    /// The last one, radians.
    #[must_use]
    pub fn angle_max(&self) -> f32 {
        self.get(self.count - 1) as f32
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::*;

    #[test]
    fn a_fan_has_both_ends_and_a_turn_has_no_bearing_twice() {
        let fan = Bearings::over(PI, 181);
        // 32 bits hold these angles to 2e-7 radians.
        assert!((fan.get(0) + PI / 2.0).abs() < 2e-7);
        assert!((fan.get(90)).abs() < 2e-5, "180 steps of one rounding");
        assert!((fan.get(180) - PI / 2.0).abs() < 2e-5);
        let turn = Bearings::over(TAU, 360);
        assert!((f64::from(turn.angle_increment).to_degrees() - 1.0).abs() < 1e-5);
        assert!((f64::from(turn.angle_max()).to_degrees() - 179.0).abs() < 1e-2);
    }
}
