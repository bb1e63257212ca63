//! Votes, hypotheses, beams and the tracker's pose, without loss, in messages of our own.

use geometry::Pose;
use messages::{
    Beam, BeamsHeader, HypothesesHeader, Hypothesis, MapHeader, PoseHeader, Vote, VotesHeader,
};
use ros::Header;
use ros::backcast_msgs as own;

/// The votes of a scan; how cells were read is that of the map, where it is known.
pub(super) fn votes(
    header: Header,
    (votes, items): (&VotesHeader, &[Vote]),
    map: Option<&MapHeader>,
) -> own::Votes {
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
        occupied_from: map.map_or(0, |map| map.occupied_from),
        free_to: map.map_or(0, |map| map.free_to),
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

pub(super) fn tracked(header: Header, from: &PoseHeader, words: &[u8]) -> own::TrackedPose {
    own::TrackedPose {
        header,
        entered_ns: from.stamp.entered_ns,
        counter: from.stamp.counter,
        map_id: from.map_id,
        sent_ns: from.sent_ns,
        tracking_ns: from.tracking_ns,
        since_ns: from.since_ns,
        since_m: from.since_m,
        map_from_laser: Pose::from(from.map_from_laser).into(),
        map_from_base: Pose::from(from.map_from_base).into(),
        map_from_odom: Pose::from(from.map_from_odom).into(),
        laser_covariance: from.laser_covariance,
        base_covariance: from.base_covariance,
        probability: from.probability,
        lead: from.lead,
        score: from.score,
        state: from.state,
        reason: from.reason,
        places: from.places,
        pose_known: from.pose_known != 0,
        mount_known: from.mount_known != 0,
        odom_known: from.odom_known != 0,
        words: String::from_utf8_lossy(words).into_owned(),
    }
}
