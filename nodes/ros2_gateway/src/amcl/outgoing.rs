//! The topics that AMCL publishes: the pose, the particle cloud and the transform from map to
//! odometry.

use messages::{HypothesesHeader, Hypothesis, PoseHeader, Stamp};
use ros::PoseWithCovarianceStamped;
use ros::nav2_msgs::ParticleCloud;
use transport::{TransportError, monotonic_ns};
use zenoh_session::Report;

use super::cloud;
use super::parameters::Parameters;
use super::standing::Standing;
use crate::GatewayError;
use crate::broadcast::{Broadcaster, Sent};
use crate::diagnostics::Diagnostics;
use crate::joined::Joined;
use crate::outgoing::odometry_of;
use crate::rmw::{Keeping, Publisher};
use crate::stamps::in_map;
use crate::verdict::Verdict;

pub(super) struct Outgoing {
    pose: Publisher<PoseWithCovarianceStamped>,
    cloud: Publisher<ParticleCloud>,
    broadcaster: Broadcaster,
    verdict: Verdict,
    pub(super) diagnostics: Diagnostics,
    standing: Standing,
    /// True if the tracker believes a pose of the robot that is not outdated.
    is_believed: bool,
    /// True if the tracker was asked to start over and has not done so yet: its pose is from
    /// before.
    is_outdated: bool,
    /// True if time is that of the scans and of `/clock`, not of this machine.
    uses_sim_time: bool,
    /// Newest time of both, nanoseconds.
    sim_ns: i64,
}

impl Outgoing {
    pub(super) fn open(
        joined: Joined<'_>,
        uses_sim_time: bool,
        sent: Sent,
    ) -> Result<Self, GatewayError> {
        let (member, topics) = (joined.member, joined.topics);
        Ok(Outgoing {
            pose: Publisher::open(member, &topics.amcl_pose, Keeping::Kept, 1)?,
            cloud: Publisher::open(member, &topics.particle_cloud, Keeping::Fresh, 5)?,
            broadcaster: Broadcaster::open(member, &topics.tf, sent)?,
            diagnostics: Diagnostics::open(member, &topics.diagnostics)?,
            verdict: Verdict::open(member, topics)?,
            standing: Standing::default(),
            is_believed: false,
            is_outdated: false,
            uses_sim_time,
            sim_ns: i64::MIN,
        })
    }

    /// Forgets the state that would be sent again.
    pub(super) fn rest(&mut self) {
        self.standing = Standing::default();
        self.is_believed = false;
        self.is_outdated = false;
    }

    /// Takes the simulation time, with which messages between scans are stamped: nothing is stamped
    /// ahead of a simulation that is paused or slow.
    pub(super) fn on_sim_time(&mut self, now_ns: i64) {
        self.sim_ns = now_ns;
        self.diagnostics.on_sim_time(now_ns);
    }

    /// Returns the time of the clock by which the transform is sent between scans.
    fn now_ns(&self) -> i64 {
        match self.uses_sim_time {
            true => self.sim_ns,
            false => monotonic_ns(),
        }
    }

    /// Converts the stamp of a scan to that clock.
    fn on_clock(&mut self, stamp: Stamp) -> Stamp {
        if !self.uses_sim_time {
            return stamp;
        }
        // Before the first message of the clock, time stands still between scans.
        self.sim_ns = self.sim_ns.max(stamp.measured_ns);
        Stamp {
            entered_ns: stamp.measured_ns,
            ..stamp
        }
    }

    /// Notes that the tracker was given a pose: its result counts again.
    pub(super) fn go_on(&mut self) {
        self.is_outdated = false;
    }

    /// Notes that the tracker was asked to forget its pose: nothing is sent of it any more.
    pub(super) fn start_over(&mut self) {
        self.rest();
        self.is_outdated = true;
    }

    /// Takes the tracker's pose at a scan; between scans the transform stays.
    pub(super) fn tracked(
        &mut self,
        (header, words): (&PoseHeader, &[u8]),
        map_frame: &str,
        report: &mut Report,
    ) -> Result<(), TransportError> {
        if header.from_scan != 1 {
            return Ok(());
        }
        let stamp = self.on_clock(header.stamp);
        self.diagnostics.on_scan(stamp);
        // The pose of a laser is not the robot's.
        self.is_outdated &= header.is_believed();
        self.is_believed = header.is_believed() && header.mount_known == 1 && !self.is_outdated;
        let found = odometry_of(header).filter(|_| self.is_believed);
        self.standing.on_scan(stamp, found);
        self.verdict.send(header, words, map_frame, report)?;
        let outcome = self.send_pose(header, map_frame, report);
        outcome.or_else(|error| report.refused(&error))
    }

    fn send_pose(
        &mut self,
        header: &PoseHeader,
        map_frame: &str,
        report: &mut Report,
    ) -> Result<(), GatewayError> {
        if !self.is_believed {
            return Ok(());
        }
        let in_map = in_map(header.stamp, map_frame)?;
        if let Some(pose) = ros::poses::tracked(in_map.clone(), header) {
            self.pose.send(&pose)?;
            report.sent();
        }
        self.cloud.send(&cloud::of_pose(in_map, header))?;
        report.sent();
        Ok(())
    }

    /// Sends the hypotheses as a particle cloud while the tracker believes no pose.
    pub(super) fn found(
        &mut self,
        header: &HypothesesHeader,
        items: &[Hypothesis],
        map_frame: &str,
        report: &mut Report,
    ) -> Result<(), TransportError> {
        if self.is_believed || header.mount_known != 1 {
            return Ok(());
        }
        let sent = in_map(header.stamp, map_frame).and_then(|in_map| {
            self.cloud
                .send(&cloud::of_hypotheses(in_map, header, items))
        });
        report.outcome(sent)
    }

    pub(super) fn tick(
        &mut self,
        map_frame: &str,
        parameters: &Parameters,
        report: &mut Report,
    ) -> Result<(), TransportError> {
        let Some(due) = self.standing.due(self.now_ns()) else {
            return Ok(());
        };
        if !parameters.is_on("tf_broadcast") {
            return Ok(());
        }
        let ahead_ns = (parameters.number("transform_tolerance") * 1e9) as i64;
        let at_ns = due.at_ns.saturating_add(ahead_ns);
        let frames = (map_frame, due.odom);
        match self.broadcaster.send(at_ns, frames, due.map_from_odom) {
            Ok(true) => report.sent(),
            Ok(false) => {}
            Err(error) => report.refused(&error)?,
        }
        Ok(())
    }
}
