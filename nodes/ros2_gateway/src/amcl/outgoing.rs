//! What AMCL publishes: the pose, where the robot may be, and the transform from map to
//! odometry.

use geometry::Pose;
use messages::{HypothesesHeader, Hypothesis, PoseHeader};
use ros::nav2_msgs::ParticleCloud;
use ros::{PoseWithCovarianceStamped, TfMessage};
use transport::{TransportError, monotonic_ns};
use zenoh_session::Report;

use super::cloud;
use super::parameters::Parameters;
use super::standing::Standing;
use crate::GatewayError;
use crate::diagnostics::Diagnostics;
use crate::outgoing::{in_map, transform};
use crate::rmw_zenoh::{Member, Publisher};
use crate::topics::Topics;

/// What goes to the robot, while the node is active.
pub(super) struct Outgoing {
    pose: Publisher<PoseWithCovarianceStamped>,
    cloud: Publisher<ParticleCloud>,
    transforms: Publisher<TfMessage>,
    pub(super) diagnostics: Diagnostics,
    standing: Standing,
    /// Whether the tracker believes a pose.
    is_believed: bool,
}

impl Outgoing {
    pub(super) fn open(member: &Member, topics: &Topics) -> Result<Self, GatewayError> {
        Ok(Outgoing {
            pose: Publisher::open_kept(member, &topics.amcl_pose, 1)?,
            cloud: Publisher::open_fresh(member, &topics.particle_cloud, 5)?,
            transforms: Publisher::open(member, &topics.tf, 100)?,
            diagnostics: Diagnostics::open(member, &topics.diagnostics)?,
            standing: Standing::default(),
            is_believed: false,
        })
    }

    /// Forgets what it would send again.
    pub(super) fn rest(&mut self) {
        self.standing = Standing::default();
        self.is_believed = false;
    }

    /// Takes the tracker's pose at a scan; between scans the transform stays.
    pub(super) fn tracked(
        &mut self,
        header: &PoseHeader,
        map_frame: &str,
        report: &mut Report,
    ) -> Result<(), TransportError> {
        if header.from_scan != 1 {
            return Ok(());
        }
        self.diagnostics.on_scan(header.stamp);
        // The pose of a laser is not the robot's.
        self.is_believed = header.is_believed() && header.mount_known == 1;
        let is_tied = self.is_believed && header.odom_known == 1;
        let found = is_tied.then(|| {
            let odom = header.odom_frame.as_str().to_owned();
            (Pose::from(header.map_from_odom), odom)
        });
        self.standing.on_scan(header.stamp, found);
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

    /// Shows where the robot may be, while the tracker believes no pose.
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
        match sent {
            Ok(()) => report.sent(),
            Err(error) => report.refused(&error)?,
        }
        Ok(())
    }

    /// Sends the transform where it is due.
    pub(super) fn tick(
        &mut self,
        map_frame: &str,
        parameters: &Parameters,
        report: &mut Report,
    ) -> Result<(), TransportError> {
        let Some(due) = self.standing.due(monotonic_ns()) else {
            return Ok(());
        };
        if !parameters.is_on("tf_broadcast") {
            return Ok(());
        }
        let ahead_ns = (parameters.number("transform_tolerance") * 1e9) as i64;
        let at_ns = due.at_ns.saturating_add(ahead_ns);
        let sent = transform(at_ns, map_frame, due.odom, due.map_from_odom)
            .and_then(|transform| self.transforms.send(&transform));
        match sent {
            Ok(()) => report.sent(),
            Err(error) => report.refused(&error)?,
        }
        Ok(())
    }
}
