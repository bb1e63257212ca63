//! Converts hypotheses to pose messages that common tools understand.

use std::f64::consts::PI;

use geometry::{Covariance, Pose};
use messages::{HypothesesHeader, Hypothesis, Particle, PoseHeader, Verdict};
use nalgebra::Matrix3;

use crate::planar;
use crate::{Header, PoseArray, PoseWithCovarianceStamped};

/// Converts all hypotheses on the map of the best one, best first: poses of the base, or of the
/// laser if no mount is known.
pub fn array(header: Header, from: &HypothesesHeader, items: &[Hypothesis]) -> PoseArray {
    let pose = |item| planar::pose(robot(from, item));
    PoseArray {
        header,
        poses: from.on_map(items).map(pose).collect(),
    }
}

/// Converts the initial particles of a particle filter: poses of the base, or of the laser if no
/// mount is known.
pub fn particles(header: Header, items: &[Particle]) -> PoseArray {
    let pose = |item: &Particle| planar::pose(item.map_from_base.into());
    PoseArray {
        header,
        poses: items.iter().map(pose).collect(),
    }
}

/// Converts the best hypothesis. It keeps its own covariance only if the verdict is Unique, so that
/// no reader takes an uncertain pose as certain: if several places fit, the covariance spans them
/// with equal weight; if none fits, the robot may be anywhere.
pub fn best(
    header: Header,
    from: &HypothesesHeader,
    items: &[Hypothesis],
) -> Option<PoseWithCovarianceStamped> {
    let best = items.first()?;
    let pose = robot(from, best);
    let covariance = match Verdict::from_code(from.verdict) {
        Some(Verdict::Unique) => covariance(from, best),
        Some(Verdict::Ambiguous) => {
            let rivals = (from.alternatives as usize).saturating_add(1).max(2);
            spread(pose, from, &items[..rivals.min(items.len())])
        }
        _ => Covariance::from_deviations(ANYWHERE_M, ANYWHERE_M, PI),
    };
    Some(PoseWithCovarianceStamped {
        header,
        pose: planar::estimate(pose, covariance.to_rows()),
    })
}

/// Standard deviation of the position of a robot that may be anywhere, in metres: the width of a
/// building.
const ANYWHERE_M: f64 = 100.0;

/// Covariance of the pose that [`robot`] returns.
fn covariance(from: &HypothesesHeader, item: &Hypothesis) -> Covariance {
    let own = Covariance::from_rows(item.covariance);
    own.carried(item.map_from_laser.into(), robot(from, item))
}

/// Covariance about a pose of a robot that is at one of these places; places on other maps are left
/// out.
fn spread(about: Pose, from: &HypothesesHeader, items: &[Hypothesis]) -> Covariance {
    let on_map = from.on_map(items);
    let count = on_map.clone().count().max(1);
    let parts = on_map.map(|item| covariance(from, item).about(robot(from, item), about));
    (parts.map(Matrix3::from).sum::<Matrix3<f64>>() / count as f64).into()
}

/// Converts the tracker's pose: of the base, or of the laser if no mount is known. `None` if it
/// believes no place.
pub fn tracked(header: Header, from: &PoseHeader) -> Option<PoseWithCovarianceStamped> {
    if !from.is_believed() {
        return None;
    }
    let (pose, covariance) = match from.mount_known {
        0 => (from.map_from_laser, from.laser_covariance),
        _ => (from.map_from_base, from.base_covariance),
    };
    Some(PoseWithCovarianceStamped {
        header,
        pose: planar::estimate(pose.into(), covariance),
    })
}

/// Pose of the base, or of the laser if no mount is known.
pub fn robot(from: &HypothesesHeader, item: &Hypothesis) -> Pose {
    match from.mount_known {
        0 => item.map_from_laser.into(),
        _ => item.map_from_base.into(),
    }
}

#[cfg(test)]
mod tests {
    use bytemuck::Zeroable;
    use messages::TrackState;

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

    #[test]
    fn only_a_unique_answer_has_a_tight_covariance() {
        let at = |x: f64, probability: f32| {
            let mut item = Hypothesis::zeroed();
            item.map_from_laser.x = x;
            item.probability = probability;
            item.covariance = Covariance::from_deviations(0.1, 0.1, 0.1).to_rows();
            item
        };
        let items = [at(0.0, 0.6), at(10.0, 0.2)];
        let xx = |verdict: Verdict| {
            let header = HypothesesHeader {
                verdict: verdict as u32,
                ..HypothesesHeader::zeroed()
            };
            best(Header::default(), &header, &items)
                .unwrap()
                .pose
                .covariance[0][0]
        };
        assert!((xx(Verdict::Unique) - 0.01).abs() < 1e-9);
        // Half of the probability is 10 m away.
        assert!((xx(Verdict::Ambiguous) - 50.01).abs() < 1e-6);
        assert_eq!(xx(Verdict::PoorFit), 1e4);
        assert_eq!(
            best(Header::default(), &HypothesesHeader::zeroed(), &[]),
            None
        );
    }

    #[test]
    fn the_tracker_has_a_pose_or_none() {
        let mut header = PoseHeader::zeroed();
        header.map_from_laser.x = 1.0;
        header.map_from_base.x = 2.0;
        assert_eq!(tracked(Header::default(), &header), None);
        header.pose_known = 1;
        assert_eq!(tracked(Header::default(), &header), None, "it is searching");
        header.state = TrackState::Doubtful as u32;
        let x = |header: &PoseHeader| {
            tracked(Header::default(), header).map(|p| p.pose.pose.position.x)
        };
        assert_eq!(x(&header), Some(1.0));
        header.mount_known = 1;
        assert_eq!(x(&header), Some(2.0));
    }
}
