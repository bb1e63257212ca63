//! Angles in radians.

use std::f64::consts::{PI, TAU};

/// Wraps an angle to `(-π, π]`. NaN and infinities give NaN.
#[must_use]
pub fn wrap_angle(angle: f64) -> f64 {
    let wrapped = angle.rem_euclid(TAU);
    if wrapped > PI { wrapped - TAU } else { wrapped }
}

/// Returns the unsigned angle between two headings, in `[0, π]`.
#[must_use]
pub fn angle_between(a: f64, b: f64) -> f64 {
    wrap_angle(a - b).abs()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wraps_to_the_half_open_turn() {
        assert_eq!(wrap_angle(PI), PI);
        assert_eq!(wrap_angle(-PI), PI);
        assert_eq!(wrap_angle(0.0), 0.0);
        // 2.5 π less a full turn: the sum is exact to one rounding.
        assert!((wrap_angle(2.5 * PI) - 0.5 * PI).abs() < 1e-15);
        assert!(wrap_angle(f64::INFINITY).is_nan());
    }

    #[test]
    fn the_angle_between_headings_crosses_the_seam() {
        let across = angle_between(PI - 0.1, -PI + 0.1);
        assert!((across - 0.2).abs() < 1e-12, "{across}");
    }
}
