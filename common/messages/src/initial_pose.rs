//! What an operator or another program says of where the robot is.

use bytemuck::{Pod, Zeroable};
use serde::{Deserialize, Serialize};

#[cfg(feature = "iceoryx2")]
use crate::zero_copy::ZeroCopySend;
use crate::{Pose2, Stamp};

/// The message of topic `initial_pose`.
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable, Serialize, Deserialize)]
#[cfg_attr(
    feature = "iceoryx2",
    derive(ZeroCopySend),
    type_name("InitialPose/v2")
)]
#[repr(C)]
pub struct InitialPose {
    /// When it was said.
    pub stamp: Stamp,
    /// An [`InitialPoseKind`].
    pub kind: u64,
    /// Pose of the robot's base in the map; the laser's where no mount is known. Not read
    /// where the robot may be anywhere.
    pub map_from_base: Pose2,
    /// Of that pose, row by row over x, y and yaw: m², m·rad, rad².
    pub covariance: [f64; 9],
}

/// What is said.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(u64)]
pub enum InitialPoseKind {
    /// The robot should be at the pose: it is tried first, and scans must confirm it.
    Hint = 0,
    /// The robot is at the pose: it is believed at once, until scans speak against it.
    Believed = 1,
    /// The robot may be anywhere: what is known of its pose is forgotten.
    Anywhere = 2,
}

impl InitialPoseKind {
    /// The kind with this number, if there is one.
    #[must_use]
    pub fn from_code(code: u64) -> Option<Self> {
        [Self::Hint, Self::Believed, Self::Anywhere]
            .into_iter()
            .find(|kind| *kind as u64 == code)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    crate::pin_layout!(InitialPose, size 128, align 8, {
        stamp: 0, kind: 24, map_from_base: 32, covariance: 56,
    });

    #[test]
    fn codes_are_found_again() {
        for code in 0..3 {
            assert_eq!(
                InitialPoseKind::from_code(code).map(|k| k as u64),
                Some(code)
            );
        }
        assert_eq!(InitialPoseKind::from_code(3), None);
    }
}
