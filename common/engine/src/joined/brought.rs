//! How scans were brought to one time, and what an operator should know of it.

use messages::Name;

use crate::EngineError;

/// How scans were brought to one time.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Brought {
    /// Lasers that were joined.
    pub lasers: u32,
    /// Those that were left out, and why.
    pub left_out: Vec<(Name, LeftOut)>,
    /// How their motion was known.
    pub motion: MotionKnown,
}

/// How the motion within a scan, and between scans, was known; the worse, the greater.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Default)]
pub enum MotionKnown {
    /// It was not asked for: all beams are of one time.
    #[default]
    NotNeeded,
    /// By odometry around the scans.
    ByOdometry,
    /// Odometry ended before the last beam, and its last twist was taken to go on.
    LastTwist,
    /// No odometry reaches the scan; the robot is taken to have stood still.
    Unknown,
}

/// Why a laser was left out.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum LeftOut {
    /// It sent nothing yet.
    #[error("no scan received")]
    NoScan,
    /// Its newest scan is too old.
    #[error("its newest scan is {age_ms} ms older, more than 1.5 scan periods")]
    Old {
        /// Milliseconds before the first laser's scan.
        age_ms: i64,
    },
    /// It is not known where it sits.
    #[error("its mount on the base is not known")]
    NoMount,
    /// The robot moves, and odometry does not reach the scan.
    #[error("no odometry for the robot's motion since")]
    NoOdometry,
    /// Its scan is refused.
    #[error(transparent)]
    Refused(EngineError),
}

impl Brought {
    /// What an operator should know, where odometry flows or not; figures that change
    /// from scan to scan are left out.
    #[must_use]
    pub fn notes(&self, odometry_flows: bool) -> Vec<String> {
        let left_out = self.left_out.iter().map(|(laser, why)| match why {
            LeftOut::Old { .. } => format!("laser {laser} is ignored: its scans are too old"),
            other => format!("laser {laser} is ignored: {other}"),
        });
        let motion = match self.motion {
            MotionKnown::LastTwist => Some("odometry is late: extrapolating with its last twist"),
            MotionKnown::Unknown if odometry_flows => {
                Some("odometry does not cover the scans: motion is not compensated")
            }
            _ => None,
        };
        left_out.chain(motion.map(str::to_owned)).collect()
    }
}
