//! Result of joining scans, and warnings about it for the operator.

use messages::Name;

use crate::EngineError;

/// Result of joining scans.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Brought {
    /// Number of lasers joined.
    pub lasers: u32,
    /// Lasers left out, with the reasons.
    pub left_out: Vec<(Name, LeftOut)>,
    /// Source of their motion.
    pub motion: MotionKnown,
}

/// Source of the motion within a scan and between scans, in order from best to worst.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Default)]
pub enum MotionKnown {
    /// Not needed: all beams count as measured at one time.
    #[default]
    NotNeeded,
    /// Odometry around the scans.
    ByOdometry,
    /// The last twist: odometry ended before the last beam.
    LastTwist,
    /// Unknown: no odometry reaches the scan, and the robot is assumed to stand still.
    Unknown,
}

/// Reason why a laser was left out.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub enum LeftOut {
    /// The laser has not sent any scan yet.
    #[error("no scan received")]
    NoScan,
    /// The newest scan is too old.
    #[error("its newest scan is {age_ms} ms older, more than 1.5 scan periods")]
    Old {
        /// Milliseconds before the first laser's scan.
        age_ms: i64,
    },
    /// The mount on the base is unknown.
    #[error("its mount on the base is not known")]
    NoMount,
    /// The robot moves, and odometry does not reach the scan.
    #[error("no odometry for the robot's motion since")]
    NoOdometry,
    /// The scan is rejected.
    #[error(transparent)]
    Refused(EngineError),
}

impl Brought {
    /// Returns warnings for the operator, without figures that change from scan to scan.
    /// `odometry_flows` is true if any odometry has arrived.
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
