//! A robot that is followed, and of which is then not known how it moved.

use engine::tracking::TrackingConfig;
use geometry::Pose;
use offline::World;

use super::drive::Moment;
use super::run::{Run, Said};
use crate::EvaluationError;

/// The robot is followed for this many metres before, and for this many after.
pub(super) const BEFORE_M: f64 = 5.0;
const AFTER_M: f64 = 10.0;
/// It is to be right after this many.
pub(super) const RIGHT_AFTER_M: f64 = 5.0;

/// The moments on both sides, and how odometry says that the robot moved between.
#[derive(Debug, Clone, Copy)]
pub(super) struct Interruption {
    pub(super) from: usize,
    pub(super) to: usize,
    pub(super) moved: Option<Pose>,
}

/// What the tracker says after it.
#[derive(Debug)]
pub(super) struct Aftermath {
    /// Of the moment after it, and those that follow.
    pub(super) said: Vec<Said>,
    pub(super) is_right: bool,
}

impl Interruption {
    /// Follows the robot up to the interruption and on from there; `None` where it was not
    /// right before.
    pub(super) fn evaluate(
        &self,
        world: &World,
        moments: &[Moment],
        config: TrackingConfig,
    ) -> Result<Option<Aftermath>, EvaluationError> {
        let Interruption { from, to, moved } = *self;
        let mut run = Run::new(world, moments, config);
        if !run.follow_to(from, BEFORE_M)? {
            return Ok(None);
        }
        let (mut said, mut is_right) = (Vec::new(), false);
        for (index, moment) in moments.iter().enumerate().skip(to) {
            let gone = moment.gone_m - moments[to].gone_m;
            if gone > AFTER_M {
                break;
            }
            let moved = if index == to { moved } else { moment.moved };
            let now = run.take(index, moved)?;
            if gone <= RIGHT_AFTER_M && now.off.is_some() {
                is_right = now.is_right();
            }
            said.push(now);
        }
        Ok(Some(Aftermath { said, is_right }))
    }
}
