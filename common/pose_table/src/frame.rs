//! Frame whose pose is printed. Pure.

use messages::Pose2;
use schemars::JsonSchema;
use serde::Serialize;

/// The base, or the laser where its mount is not known.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Frame {
    Base,
    Laser,
}

impl Frame {
    #[must_use]
    pub fn of(mount_is_known: bool) -> Self {
        match mount_is_known {
            true => Frame::Base,
            false => Frame::Laser,
        }
    }

    /// Returns the pose of this frame.
    #[must_use]
    pub fn pose(self, map_from_base: Pose2, map_from_laser: Pose2) -> Pose2 {
        match self {
            Frame::Base => map_from_base,
            Frame::Laser => map_from_laser,
        }
    }

    /// Returns the names of the columns of its position.
    pub(super) fn columns(self) -> [&'static str; 2] {
        match self {
            Frame::Base => ["base x m", "base y m"],
            Frame::Laser => ["laser x m", "laser y m"],
        }
    }
}
