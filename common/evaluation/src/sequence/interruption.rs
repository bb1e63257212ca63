//! A followed robot whose motion is unknown or wrong for one step.

use engine::tracking::TrackingConfig;
use geometry::Pose;
use offline::World;

use super::drive::Moment;
use super::run::{Run, Said};

/// Distance for which the robot is followed before and after, in metres.
pub(super) const BEFORE_M: f64 = 5.0;
const AFTER_M: f64 = 10.0;
/// Distance after which it should be right, in metres.
pub(super) const RIGHT_AFTER_M: f64 = 5.0;

/// The last moment before, the first one after, and the odometry's motion in between.
#[derive(Debug, Clone, Copy)]
pub(super) struct Interruption {
    pub(super) from: usize,
    pub(super) to: usize,
    pub(super) moved: Option<Pose>,
}

/// Results of the tracker after an interruption.
#[derive(Debug)]
pub(super) struct Aftermath {
    /// Results from the first moment after the interruption on.
    pub(super) said: Vec<Said>,
    pub(super) is_right: bool,
}

impl Interruption {
    /// Follows the robot up to the interruption and on from there; `None` if it was not right
    /// before.
    pub(super) fn evaluate(
        &self,
        world: &World,
        moments: &[Moment],
        config: TrackingConfig,
    ) -> anyhow::Result<Option<Aftermath>> {
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
