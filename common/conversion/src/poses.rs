//! Hypotheses as poses that every tool knows.

use geometry::Pose;
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
    let covariance = moved(best.covariance, best.map_from_laser.into(), pose);
    PoseWithCovarianceStamped {
        header,
        pose: planar::estimate(pose, covariance),
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

/// The covariance of pose `of`, where `covariance` is that of pose `known` and
/// the two are fixed to each other: a turn about the one moves the other.
fn moved(covariance: [f64; 9], known: Pose, of: Pose) -> [f64; 9] {
    let (dx, dy) = (of.x - known.x, of.y - known.y);
    let jacobian = [[1.0, 0.0, -dy], [0.0, 1.0, dx], [0.0, 0.0, 1.0]];
    std::array::from_fn(|i| {
        let (row, column) = (jacobian[i / 3], jacobian[i % 3]);
        let terms = covariance.iter().enumerate();
        terms
            .map(|(k, value)| row[k / 3] * value * column[k % 3])
            .sum()
    })
}

#[cfg(test)]
mod tests {
    use bytemuck::Zeroable;

    use super::*;

    #[test]
    fn the_base_is_less_sure_to_the_side_than_the_laser_ahead_of_it() {
        let known = Pose::new(5.0, 5.0, 0.0);
        let base = Pose::new(4.0, 5.0, 0.0);
        let covariance = [0.01, 0.0, 0.0, 0.0, 0.01, 0.0, 0.0, 0.0, 0.04];
        let expected = [0.01, 0.0, 0.0, 0.0, 0.05, -0.04, 0.0, -0.04, 0.04];
        for (found, expected) in moved(covariance, known, base).iter().zip(expected) {
            // A few products and sums.
            assert!(
                (found - expected).abs() < 1e-15,
                "{found} is not {expected}"
            );
        }
        assert_eq!(moved(covariance, known, known), covariance);
    }

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
