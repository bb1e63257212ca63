//! Finds out if the beams of a laser that is marked as upside down run as its line says, or the
//! other way.
//!
//! CARMEN's own driver reverses the readings of such a laser before they are logged
//! (`laser/laser_ipc.c`); other programs log them as measured. The scans show it: if the robot
//! turns left, the surroundings move to the right.

use super::carmen::Laser;

/// Turns between scans that are evaluated, in radians: smaller ones move too few beams, and after
/// larger ones the scans overlap too little.
const TURNS: std::ops::RangeInclusive<f64> = 0.03..=0.5;

/// Smallest number of beams in the overlap of two scans.
const MIN_BEAMS: usize = 20;

/// Upper limit of a difference, in metres, so that a few edges do not decide.
const MAX_DIFFERENCE_M: f32 = 0.5;

/// A direction fits if its mean difference is at most this share of the other's.
const CLEAR: f32 = 0.8;

#[derive(Debug, Default)]
pub(super) struct Turning {
    last: Option<(f64, Vec<f32>)>,
    as_logged: u32,
    mirrored: u32,
}

impl Turning {
    /// Adds a scan with its heading and the step between its beams.
    pub(super) fn note(&mut self, laser: &Laser, yaw: f64, step: f64) {
        if let Some((last_yaw, last)) = &self.last
            && last.len() == laser.ranges.len()
        {
            let turn = geometry::wrap_angle(yaw - last_yaw);
            if turn.abs() < *TURNS.start() {
                // The next scan is compared with the same last one, until the turn is large enough.
                return;
            }
            if TURNS.contains(&turn.abs()) && step != 0.0 {
                let beams = (turn / step).round() as i64;
                let logged = difference(last, &laser.ranges, beams);
                let mirrored = difference(last, &laser.ranges, -beams);
                if let (Some(logged), Some(mirrored)) = (logged, mirrored) {
                    self.as_logged += u32::from(logged < CLEAR * mirrored);
                    self.mirrored += u32::from(mirrored < CLEAR * logged);
                }
            }
        }
        self.last = Some((yaw, laser.ranges.clone()));
    }

    /// True if the beams run the other way; `None` if the scans do not show it.
    pub(super) fn is_mirrored(&self) -> Option<bool> {
        if self.mirrored > 2 * self.as_logged {
            Some(true)
        } else if self.as_logged > 2 * self.mirrored {
            Some(false)
        } else {
            None
        }
    }
}

/// Mean difference between `new` and `old` if the content of a beam has moved by `shift` beams
/// towards the first one.
fn difference(old: &[f32], new: &[f32], shift: i64) -> Option<f32> {
    let skip = |by: i64| usize::try_from(by.max(0)).unwrap_or(usize::MAX);
    let pairs = old
        .iter()
        .skip(skip(shift))
        .zip(new.iter().skip(skip(-shift)));
    let both = pairs.filter(|(old, new)| old.is_finite() && new.is_finite());
    let (count, sum) = both.fold((0usize, 0.0), |(count, sum), (old, new)| {
        (count + 1, sum + (old - new).abs().min(MAX_DIFFERENCE_M))
    });
    (count >= MIN_BEAMS).then(|| sum / count as f32)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A scan of a room of 6 by 4 m from its middle, one beam per degree.
    fn scan(yaw: f64, is_mirrored: bool) -> Laser {
        let range = |degree: i32| {
            let sign = if is_mirrored { -1.0 } else { 1.0 };
            let (sin, cos) = (yaw + sign * f64::from(degree).to_radians()).sin_cos();
            (3.0 / cos.abs()).min(2.0 / sin.abs()) as f32
        };
        Laser::old(1, (-90..=90).map(range).collect())
    }

    fn is_turned(yaws: &[f64], is_mirrored: bool) -> Option<bool> {
        let mut turning = Turning::default();
        for &yaw in yaws {
            turning.note(&scan(yaw, is_mirrored), yaw, 1f64.to_radians());
        }
        turning.is_mirrored()
    }

    #[test]
    fn a_turning_robot_shows_which_way_beams_run() {
        for yaws in [[0.3, 0.4, 0.5], [0.5, 0.4, 0.3], [3.1, -3.1, -3.0]] {
            assert_eq!(is_turned(&yaws, true), Some(true), "{yaws:?}");
            assert_eq!(is_turned(&yaws, false), Some(false), "{yaws:?}");
        }
        // Small turns add up.
        let slow: Vec<f64> = (0..20).map(|i| 0.3 + 0.01 * f64::from(i)).collect();
        assert_eq!(is_turned(&slow, true), Some(true));
        assert_eq!(is_turned(&slow, false), Some(false));
    }

    #[test]
    fn a_robot_that_stands_shows_nothing() {
        assert_eq!(is_turned(&[0.3, 0.3, 0.3], true), None);
        assert_eq!(is_turned(&[], true), None);
        assert_eq!(is_turned(&[0.0, 2.0], true), None);
    }
}
