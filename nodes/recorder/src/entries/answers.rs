//! Votes, hypotheses and beams: without loss in messages of our own, and as poses for
//! every tool.

use geometry::Pose;
use messages::{Beam, BeamsHeader, HypothesesHeader, Hypothesis, Vote, VotesHeader};
use recording::ros::backcast_msgs as own;
use recording::ros::{Header, PoseArray, PoseWithCovarianceStamped};

use super::planar;

pub(super) fn votes(header: Header, votes: &VotesHeader, items: &[Vote]) -> own::Votes {
    let vote = |vote: &Vote| own::Vote {
        x: vote.x,
        y: vote.y,
        heading: vote.heading,
        intensity: vote.intensity,
    };
    own::Votes {
        header,
        entered_ns: votes.stamp.entered_ns,
        counter: votes.stamp.counter,
        map_id: votes.map_id,
        total: votes.total,
        engine_ns: votes.engine_ns,
        poses_evaluated: votes.poses_evaluated,
        outcome: votes.outcome,
        headings: votes.headings,
        floor: votes.floor,
        certified_floor: votes.certified_floor,
        best: votes.best,
        highest_possible: votes.highest_possible,
        truncated: votes.truncated != 0,
        heading_known: votes.heading_known != 0,
        mount_known: votes.mount_known != 0,
        beams_used: votes.beams_used,
        beams_silent: votes.beams_silent,
        known_heading: votes.known_heading,
        bearing_rounding: votes.bearing_rounding,
        base_from_laser: Pose::from(votes.base_from_laser).into(),
        occupied_from: votes.occupied_from,
        free_to: votes.free_to,
        max_beams: votes.max_beams,
        pooling: votes.pooling,
        beam_arc_m: votes.beam_arc_m,
        votes: items.iter().map(vote).collect(),
    }
}

pub(super) fn hypotheses(
    header: Header,
    from: &HypothesesHeader,
    items: &[Hypothesis],
) -> own::Hypotheses {
    let hypothesis = |item: &Hypothesis| own::Hypothesis {
        map_from_laser: Pose::from(item.map_from_laser).into(),
        map_from_base: Pose::from(item.map_from_base).into(),
        covariance: item.covariance,
        score: item.score,
        probability: item.probability,
        intensity: item.intensity,
        support: item.support,
    };
    own::Hypotheses {
        header,
        entered_ns: from.stamp.entered_ns,
        counter: from.stamp.counter,
        map_id: from.map_id,
        sent_ns: from.sent_ns,
        search_ns: from.search_ns,
        extract_ns: from.extract_ns,
        verdict: from.verdict,
        alternatives: from.alternatives,
        confidence: from.confidence,
        inlier_share: from.inlier_share,
        best: from.best,
        highest_possible: from.highest_possible,
        mount_known: from.mount_known != 0,
        hypotheses: items.iter().map(hypothesis).collect(),
    }
}

pub(super) fn beams(header: Header, from: &BeamsHeader, items: &[Beam]) -> own::Beams {
    let beam = |beam: &Beam| own::Beam {
        bearing: beam.bearing,
        range_m: beam.range_m,
        weight: beam.weight,
        fate: beam.fate,
    };
    own::Beams {
        header,
        entered_ns: from.stamp.entered_ns,
        counter: from.stamp.counter,
        map_id: from.map_id,
        map_from_laser: Pose::from(from.map_from_laser).into(),
        beams: items.iter().map(beam).collect(),
    }
}

/// All hypotheses, best first: of the base, or of the laser where no mount is
/// known.
pub(super) fn poses(header: Header, from: &HypothesesHeader, items: &[Hypothesis]) -> PoseArray {
    let pose = |item| planar::pose(robot(from, item));
    PoseArray {
        header,
        poses: items.iter().map(pose).collect(),
    }
}

/// The best one, with its covariance.
pub(super) fn best(
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
pub(super) fn robot(from: &HypothesesHeader, item: &Hypothesis) -> Pose {
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
            poses(Header::default(), &header, &[item]).poses[0]
                .position
                .x,
            2.0
        );
    }
}
