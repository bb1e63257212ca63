//! Messages from the graph to the robot.

use geometry::Pose;
use messages::{HypothesesHeader, Hypothesis, PoseHeader, Stamp, Verdict};
use ros::{PoseArray, PoseWithCovarianceStamped};
use zenoh_session::Report;

use crate::GatewayError;
use crate::broadcast::{Broadcaster, Sent};
use crate::config::Reach;
use crate::diagnostics::Diagnostics;
use crate::frames::Frames;
use crate::joined::Joined;
use crate::rmw::{Keeping, Publisher};
use crate::seeding::{Answer, Reason, Seeding};
use crate::stamps::in_map;

/// Minimum probability of a hypothesis that the filter's pose is compared with: of up to 64
/// hypotheses, one is near any pose.
pub(crate) const LIKELY: f32 = 0.01;

pub(crate) struct Outgoing {
    initial_pose: Publisher<PoseWithCovarianceStamped>,
    hypotheses: Publisher<PoseArray>,
    pub(crate) diagnostics: Diagnostics,
    /// `None` without `--broadcast-tf`.
    broadcaster: Option<Broadcaster>,
    ahead_ns: i64,
    spread: Reach,
    /// Pose of the odometry's frame in the map, and its name, by the last Unique verdict.
    map_from_odom: Option<(Pose, String)>,
    /// True if there is a tracker, which then provides the pose.
    is_tracked: bool,
}

impl Outgoing {
    pub(crate) fn open(joined: Joined<'_>, sent: Sent) -> Result<Self, GatewayError> {
        let (member, config, topics) = (joined.member, joined.config, joined.topics);
        let broadcaster = config
            .broadcast_tf
            .then(|| Broadcaster::open(member, &topics.tf, sent));
        Ok(Outgoing {
            initial_pose: Publisher::open_blocking(member, &topics.initial_pose, 1)?,
            hypotheses: Publisher::open(member, &topics.hypotheses, Keeping::Reliable, 10)?,
            diagnostics: Diagnostics::open(member, &topics.diagnostics)?,
            broadcaster: broadcaster.transpose()?,
            ahead_ns: (config.tf_ahead * 1e9) as i64,
            spread: config.spread,
            map_from_odom: None,
            is_tracked: false,
        })
    }

    pub(crate) fn answer(
        &mut self,
        (header, items): (&HypothesesHeader, &[Hypothesis]),
        map_frame: &str,
        frames: &Frames,
        seeding: &mut Seeding,
        report: &mut Report,
    ) -> Result<(), GatewayError> {
        self.diagnostics.on_scan(header.stamp);
        let reason = match self.is_tracked {
            true => None,
            false => seeding.on_answer(answer(header, items)),
        };
        let in_map = in_map(header.stamp, map_frame)?;
        let best = ros::poses::best(in_map.clone(), header, items);
        if let (Some(reason), Some(best), Some(pose)) = (reason, items.first(), best) {
            let at = ros::poses::robot(header, best);
            self.seed(reason, (pose, at), report)?;
        }
        let poses = ros::poses::array(in_map.clone(), header, items);
        self.hypotheses.send(&poses)?;
        report.sent();
        if self.is_tracked {
            return Ok(());
        }
        if is_unique(header)
            && let Some(best) = items.first()
        {
            self.map_from_odom = frames.map_from_odom(header, best);
        }
        self.broadcast(header.stamp, map_frame, report)
    }

    /// Notes that there is a tracker: hypotheses of single scans are not sent as the robot's pose
    /// any more, not even before the tracker's first pose.
    pub(crate) fn expect_tracker(&mut self) {
        self.is_tracked = true;
    }

    pub(crate) fn tracked(
        &mut self,
        header: &PoseHeader,
        map_frame: &str,
        seeding: &mut Seeding,
        report: &mut Report,
    ) -> Result<(), GatewayError> {
        self.expect_tracker();
        if header.from_scan != 1 {
            return Ok(());
        }
        self.diagnostics.on_scan(header.stamp);
        let reason = seeding.on_answer(tracked(header));
        let in_map = in_map(header.stamp, map_frame)?;
        let pose = ros::poses::tracked(in_map.clone(), header);
        if let (Some(reason), Some(pose)) = (reason, pose) {
            self.seed(reason, (pose, header.map_from_base.into()), report)?;
        }
        self.map_from_odom = odometry_of(header);
        self.broadcast(header.stamp, map_frame, report)
    }

    fn seed(
        &mut self,
        reason: Reason,
        (pose, at): (PoseWithCovarianceStamped, Pose),
        report: &mut Report,
    ) -> Result<(), GatewayError> {
        self.initial_pose.send(&spread(pose, self.spread))?;
        report.sent();
        let (x, y, yaw_deg) = (at.x, at.y, at.yaw.to_degrees());
        tracing::info!(?reason, x, y, yaw_deg, "sent the initial pose to the robot");
        Ok(())
    }

    /// Sends the last known transform with the stamp of this scan: it stays valid while the
    /// odometry goes on.
    fn broadcast(
        &mut self,
        of: Stamp,
        map_frame: &str,
        report: &mut Report,
    ) -> Result<(), GatewayError> {
        let (Some(broadcaster), Some((pose, odom))) = (&mut self.broadcaster, &self.map_from_odom)
        else {
            return Ok(());
        };
        let at_ns = of.measured_ns.saturating_add(self.ahead_ns);
        if broadcaster.send(at_ns, (map_frame, odom), *pose)? {
            report.sent();
        }
        Ok(())
    }
}

/// Returns the pose of the odometry's frame in the map, and its name, if the tracker believes one.
pub(crate) fn odometry_of(header: &PoseHeader) -> Option<(Pose, String)> {
    let is_tied = header.odom_known == 1 && header.is_believed();
    is_tied.then(|| {
        let odom = header.odom_frame.as_str().to_owned();
        (header.map_from_odom.into(), odom)
    })
}

fn is_unique(header: &HypothesesHeader) -> bool {
    Verdict::from_code(header.verdict) == Some(Verdict::Unique)
}

fn answer(header: &HypothesesHeader, items: &[Hypothesis]) -> Answer {
    let likely = header.on_map(items).enumerate();
    let likely = likely.filter(|(rank, item)| *rank == 0 || item.probability >= LIKELY);
    let poses = likely.map(|(_, item)| ros::poses::robot(header, item));
    Answer {
        measured_ns: header.stamp.measured_ns,
        // Without a known mount, the pose is that of the laser; the robot's could be a metre away.
        is_unique: is_unique(header) && header.mount_known != 0 && !items.is_empty(),
        map_from_base: poses.collect(),
    }
}

fn tracked(header: &PoseHeader) -> Answer {
    let base = header.base();
    Answer {
        measured_ns: header.stamp.measured_ns,
        is_unique: base.is_some() && header.is_unique(),
        map_from_base: base.into_iter().map(Into::into).collect(),
    }
}

/// Raises the standard deviations to `least`: particles that are drawn too close together cannot
/// adapt to unexpected motion.
fn spread(mut pose: PoseWithCovarianceStamped, least: Reach) -> PoseWithCovarianceStamped {
    let metres = least.metres * least.metres;
    let mut covariance = pose.pose.planar_covariance();
    for (index, variance) in [(0, metres), (4, metres), (8, least.radians * least.radians)] {
        covariance[index] = f64::max(covariance[index], variance);
    }
    let mut with = ros::PoseWithCovariance::from_planar(Pose::IDENTITY, covariance);
    with.pose = pose.pose.pose;
    pose.pose = with;
    pose
}

#[cfg(test)]
mod tests {
    use bytemuck::Zeroable;
    use messages::TrackState;

    use super::*;

    #[test]
    fn an_initial_pose_is_as_unsure_as_is_asked() {
        let least = Reach {
            metres: 0.5,
            radians: 0.25,
        };
        let mut pose = PoseWithCovarianceStamped::default();
        pose.pose.pose.position.x = 3.0;
        pose.pose.covariance[0][0] = 1.0;
        pose.pose.covariance[0][1] = 0.125;
        let pose = spread(pose, least);
        let expected = [1.0, 0.125, 0.0, 0.0, 0.25, 0.0, 0.0, 0.0, 0.0625];
        assert_eq!(pose.pose.planar_covariance(), expected);
        assert_eq!(pose.pose.pose.position.x, 3.0);
    }

    #[test]
    fn a_tracker_that_is_not_sure_seeds_nothing() {
        let mut header = PoseHeader {
            state: TrackState::Unique as u32,
            pose_known: 1,
            mount_known: 1,
            ..PoseHeader::zeroed()
        };
        assert!(tracked(&header).is_unique);
        header.state = TrackState::Doubtful as u32;
        assert!(!tracked(&header).is_unique);
        header.state = TrackState::Unique as u32;
        header.mount_known = 0;
        assert!(!tracked(&header).is_unique && tracked(&header).map_from_base.is_empty());
    }

    #[test]
    fn a_pose_of_the_laser_is_not_the_robots() {
        let mut header = HypothesesHeader {
            verdict: Verdict::Unique as u32,
            mount_known: 1,
            ..HypothesesHeader::zeroed()
        };
        let items = [Hypothesis::zeroed()];
        assert!(answer(&header, &items).is_unique);
        assert!(!answer(&header, &[]).is_unique);
        header.mount_known = 0;
        assert!(!answer(&header, &items).is_unique);
        header.mount_known = 1;
        header.verdict = Verdict::Ambiguous as u32;
        assert!(!answer(&header, &items).is_unique);
    }

    #[test]
    fn unlikely_hypotheses_are_no_place_to_be() {
        let item = |x: f64, probability| {
            let mut item = Hypothesis {
                probability,
                ..Hypothesis::zeroed()
            };
            item.map_from_laser.x = x;
            item
        };
        let items = [item(1.0, 0.0), item(2.0, 0.5), item(3.0, 0.001)];
        let places = answer(&HypothesesHeader::zeroed(), &items).map_from_base;
        assert_eq!(places, [1.0, 2.0].map(|x| Pose::new(x, 0.0, 0.0)));
    }
}
