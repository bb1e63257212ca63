//! Initial poses from the command line and from topic `initial_pose`.

use geometry::{Covariance, Pose};
use messages::{InitialPose, InitialPoseKind, TrackReason};

use super::turn::Turn;
use super::{Node, TrackerError};

/// Assumed error of an initial pose from the command line: standard deviations, metres and radians.
const INITIAL_ERROR: (f64, f64) = (0.5, 0.26);

#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Initial {
    /// Pose of the base in the map, with its covariance.
    base: (Pose, Covariance),
    /// True if the pose is used before a scan confirms it.
    is_believed: bool,
}

impl Initial {
    pub(super) fn of_option(pose: Pose) -> Self {
        let (metres, radians) = INITIAL_ERROR;
        Initial {
            base: (pose, Covariance::from_deviations(metres, metres, radians)),
            is_believed: false,
        }
    }

    /// Reads the initial pose of a message; `None` if the robot may be anywhere.
    fn of_message(message: &InitialPose) -> Result<Option<Self>, String> {
        let kind = InitialPoseKind::from_code(message.kind)
            .ok_or_else(|| format!("its kind is {}: allowed are 0, 1 and 2", message.kind))?;
        if kind == InitialPoseKind::Anywhere {
            return Ok(None);
        }
        let covariance = Covariance::from_rows(message.covariance);
        let pose = Pose::from(message.map_from_base);
        match pose.is_finite() && covariance.is_positive_definite() {
            true => Ok(Some(Initial {
                base: (pose, covariance),
                is_believed: kind == InitialPoseKind::Believed,
            })),
            false => Err("the pose or its covariance is not valid".to_owned()),
        }
    }
}

impl Node {
    /// Processes an initial pose; the newest one counts.
    pub(super) fn take_initial(&mut self, message: &InitialPose) -> Result<(), TrackerError> {
        match Initial::of_message(message) {
            Ok(Some(initial)) => self.initial = Some(initial),
            Ok(None) => self.start_over()?,
            Err(reason) => self.refuse(&format!("initial pose rejected: {reason}"))?,
        }
        Ok(())
    }

    fn start_over(&mut self) -> Result<(), TrackerError> {
        tracing::info!("asked to start over: the pose is forgotten");
        if let Turn::Search { scan, .. } = self.turn {
            // The pending search is obsolete, but each scan must still get one pose.
            self.turn = Turn::Idle;
            self.send_nothing(&scan, TrackReason::NoScan)?;
        }
        self.tracker = self.nothing_known();
        self.asked = None;
        self.initial = None;
        self.remembered = None;
        self.last = None;
        self.last_state = None;
        Ok(())
    }

    /// Applies the initial pose; returns true if it is believed at the current scan.
    pub(super) fn begin_at_initial(&mut self) -> bool {
        let Some(Initial { base, is_believed }) = self.initial.take() else {
            return false;
        };
        // The user chose the pose on the displayed map.
        let map = self.shown_map();
        if !is_believed {
            self.expect_base((map, base.0), base.1);
            return false;
        }
        self.asked = None;
        let target = self.target().from_base(base.0);
        let covariance = base.1.carried(base.0, target);
        let seen = self.worlds.seen(&self.config.fit);
        self.tracker.start_at(&seen, (map, target), covariance);
        true
    }
}

#[cfg(test)]
mod tests {
    use bytemuck::Zeroable;

    use super::*;

    fn message(kind: u64) -> InitialPose {
        InitialPose {
            kind,
            map_from_base: Pose::new(1.0, 2.0, 0.5).into(),
            covariance: Covariance::from_deviations(0.1, 0.1, 0.1).to_rows(),
            ..InitialPose::zeroed()
        }
    }

    #[test]
    fn a_pose_is_a_hint_or_believed_and_anywhere_is_none() {
        for (kind, is_believed) in [(0, false), (1, true)] {
            let initial = Initial::of_message(&message(kind)).unwrap().unwrap();
            assert_eq!(initial.is_believed, is_believed);
            assert_eq!(initial.base.0, Pose::new(1.0, 2.0, 0.5));
        }
        // The pose fields are not read.
        let anywhere = InitialPose {
            kind: 2,
            map_from_base: Pose::new(f64::NAN, 0.0, 0.0).into(),
            ..InitialPose::zeroed()
        };
        assert_eq!(Initial::of_message(&anywhere), Ok(None));
        assert!(!Initial::of_option(Pose::IDENTITY).is_believed);
    }

    #[test]
    fn what_is_no_pose_is_refused() {
        let refused = |message: &InitialPose| Initial::of_message(message).unwrap_err();
        let reason = refused(&message(3));
        assert_eq!(reason, "its kind is 3: allowed are 0, 1 and 2");
        let mut wrong = message(1);
        wrong.map_from_base.x = f64::INFINITY;
        assert!(refused(&wrong).contains("not valid"));
        let mut wrong = message(0);
        wrong.covariance = [0.0; 9];
        assert!(refused(&wrong).contains("not valid"));
    }
}
