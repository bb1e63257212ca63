//! Hypotheses as poses that every tool knows.

use geometry::{Covariance, Pose};
use messages::{HypothesesHeader, Hypothesis};
use recording::ros::{Header, PoseArray, PoseWithCovarianceStamped};

use crate::planar;

/// All hypotheses, best first: of the base, or of the laser where no mount is
/// known.
#[must_use]
pub fn array(header: Header, from: &HypothesesHeader, items: &[Hypothesis]) -> PoseArray {
    let pose = |item| planar::pose(robot(from, item));
    PoseArray {
        header,
        poses: items.iter().map(pose).collect(),
    }
}

/// The best one, with its covariance.
#[must_use]
pub fn best(
    header: Header,
    from: &HypothesesHeader,
    best: &Hypothesis,
) -> PoseWithCovarianceStamped {
    let pose = robot(from, best);
    let covariance = Covariance::from_rows(best.covariance);
    let covariance = covariance.carried(best.map_from_laser.into(), pose);
    PoseWithCovarianceStamped {
        header,
        pose: planar::estimate(pose, covariance.to_rows()),
    }
}

/// The pose that is meant: of the base, or of the laser where no mount is known.
#[must_use]
pub fn robot(from: &HypothesesHeader, item: &Hypothesis) -> Pose {
    match from.mount_known {
        0 => item.map_from_laser.into(),
        _ => item.map_from_base.into(),
    }
}

#[cfg(test)]
mod tests {
    use bytemuck::Zeroable;

    use super::*;

    #[test]
    fn the_mount_decides_whose_pose_is_meant() {
        let mut item = Hypothesis::zeroed();
        item.map_from_laser.x = 1.0;
        item.map_from_base.x = 2.0;
        let mut header = HypothesesHeader::zeroed();
        assert_eq!(robot(&header, &item).x, 1.0);
        header.mount_known = 1;
        assert_eq!(robot(&header, &item).x, 2.0);
        assert_eq!(
            array(Header::default(), &header, &[item]).poses[0]
                .position
                .x,
            2.0
        );
    }
}
