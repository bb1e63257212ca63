//! Mount of a laser on the robot.

use std::str::FromStr;

use crate::Pose;

/// Mount of a laser on the robot.
///
/// As text it is `X,Y,YAW_DEG`: metres ahead, metres to the left and degrees counter-clockwise; or
/// `X,Y,YAW_DEG,180` for a laser mounted upside down.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Mount {
    /// Pose seen from above; its yaw is that of the laser's x axis.
    pub base_from_laser: Pose,
    /// True if it is mounted upside down: rolled by half a turn about its x axis, so that its left
    /// is on the right.
    pub is_upside_down: bool,
}

/// Largest distance of a laser from the base of its robot, in metres.
const MAX_DISTANCE_M: f64 = 10.0;

/// Error of a text that is not a mount.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error(
    "expected are three finite numbers, X,Y,YAW_DEG, within {MAX_DISTANCE_M} metres (not \
     millimetres) of the base, and of a laser upside down 180 as the fourth"
)]
pub struct MountError;

impl FromStr for Mount {
    type Err = MountError;

    fn from_str(text: &str) -> Result<Self, MountError> {
        let number = |word: &str| word.trim().parse().ok().filter(|n: &f64| n.is_finite());
        let numbers: Option<Vec<f64>> = text.split(',').map(number).collect();
        let (x, y, yaw_deg, is_upside_down) = match numbers.as_deref() {
            Some(&[x, y, yaw_deg]) => (x, y, yaw_deg, false),
            Some(&[x, y, yaw_deg, roll_deg]) if [0.0, 180.0, -180.0].contains(&roll_deg) => {
                (x, y, yaw_deg, roll_deg != 0.0)
            }
            _ => return Err(MountError),
        };
        if x.hypot(y) > MAX_DISTANCE_M {
            return Err(MountError);
        }
        Ok(Mount {
            base_from_laser: Pose::new(x, y, yaw_deg.to_radians()),
            is_upside_down,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_mount_is_three_numbers_or_four() {
        let mount = |is_upside_down| Mount {
            base_from_laser: Pose::new(0.78, 0.0, -std::f64::consts::FRAC_PI_2),
            is_upside_down,
        };
        for (text, is_upside_down) in [
            ("0.78,0,-90", false),
            ("0.78, 0,-90", false),
            ("0.78,0,-90,0", false),
            ("0.78,0,-90,180", true),
            ("0.78,0,-90,-180", true),
        ] {
            assert_eq!(text.parse(), Ok(mount(is_upside_down)), "{text}");
        }
        for wrong in [
            "",
            "1,2",
            "1,2,x",
            "1,2,inf",
            "1,NaN,3",
            "1,2,3,",
            "1,2,3,x",
            "1,2,3,90",
            "1,2,3,0,0",
            "780,0,0",
            "8,8,0",
        ] {
            assert_eq!(wrong.parse::<Mount>(), Err(MountError), "{wrong}");
        }
    }
}
