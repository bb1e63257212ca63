//! Bearings of the beams of a scan.

use std::f64::consts::TAU;

/// Evenly spaced bearings in the 32-bit precision of a `LaserScan`; rays are cast along exactly
/// these.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bearings {
    /// First bearing, radians counter-clockwise from ahead.
    pub angle_min: f32,
    /// Step between bearings, radians.
    pub angle_increment: f32,
    /// Number of bearings, at least two.
    pub count: usize,
}

impl Bearings {
    /// Bearings over a field of view that is centred ahead; over a full turn, the last one is a
    /// step before the first.
    pub fn over(field_of_view: f64, count: usize) -> Self {
        // Less than a thousandth of a step below a turn is a rounded full turn.
        let is_turn = field_of_view > TAU * (1.0 - 1e-3 / count as f64);
        let steps = if is_turn { count } else { count - 1 };
        Bearings {
            angle_min: (-field_of_view / 2.0) as f32,
            angle_increment: (field_of_view / steps as f64) as f32,
            count,
        }
    }

    pub fn get(&self, i: usize) -> f64 {
        f64::from(self.angle_min) + i as f64 * f64::from(self.angle_increment)
    }

    /// The last bearing, radians.
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
        // 32-bit floats represent these angles to 2e-7 radians.
        assert!((fan.get(0) + PI / 2.0).abs() < 2e-7);
        assert!((fan.get(90)).abs() < 2e-5, "180 steps of one rounding");
        assert!((fan.get(180) - PI / 2.0).abs() < 2e-5);
        let turn = Bearings::over(TAU, 360);
        assert!((f64::from(turn.angle_increment).to_degrees() - 1.0).abs() < 1e-5);
        assert!((f64::from(turn.angle_max()).to_degrees() - 179.0).abs() < 1e-2);
    }
}
