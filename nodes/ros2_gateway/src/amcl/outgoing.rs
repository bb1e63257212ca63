//! What AMCL publishes: the pose, where the robot may be, and the transform from map to
//! odometry.

use geometry::Pose;
use messages::{HealthHeader, HypothesesHeader, Hypothesis, PoseHeader, Stamp};
use ros::nav2_msgs::ParticleCloud;
use ros::{DiagnosticArray, Header, PoseWithCovarianceStamped, TfMessage, TransformStamped};
use transport::{TransportError, monotonic_ns, wall_ns};
use zenoh_session::Report;

use super::cloud;
use super::parameters::Parameters;
use super::standing::Standing;
use crate::GatewayError;
use crate::outgoing::{in_map, stamp};
use crate::rmw_zenoh::{Member, Publisher};
use crate::topics::Topics;

/// What goes to the robot, while the node is active.
pub(super) struct Outgoing {
    pose: Publisher<PoseWithCovarianceStamped>,
    cloud: Publisher<ParticleCloud>,
    transforms: Publisher<TfMessage>,
    diagnostics: Publisher<DiagnosticArray>,
    standing: Standing,
    /// Whether the tracker believes a pose.
    is_believed: bool,
    /// The newest scan: where the robot's clock meets the host's.
    newest: Option<Stamp>,
}

impl Outgoing {
    pub(super) fn open(member: &Member, topics: &Topics) -> Result<Self, GatewayError> {
        Ok(Outgoing {
            pose: Publisher::open_kept(member, &topics.amcl_pose, 1)?,
            cloud: Publisher::open_fresh(member, &topics.particle_cloud, 5)?,
            transforms: Publisher::open(member, &topics.tf, 100)?,
            diagnostics: Publisher::open(member, &topics.diagnostics, 10)?,
            standing: Standing::default(),
            is_believed: false,
            newest: None,
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
        self.newest = Some(header.stamp);
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
        let sent = stamp(due.at_ns.saturating_add(ahead_ns)).and_then(|stamp| {
            let transform = TransformStamped {
                header: Header {
                    stamp,
                    frame_id: map_frame.to_owned(),
                },
                child_frame_id: due.odom.to_owned(),
                transform: ros::planar::transform(due.map_from_odom),
            };
            self.transforms.send(&TfMessage {
                transforms: vec![transform],
            })
        });
        match sent {
            Ok(()) => report.sent(),
            Err(error) => report.refused(&error)?,
        }
        Ok(())
    }

    /// Sends the state of a node of the graph, also while this one is not active.
    pub(super) fn health(
        &mut self,
        health: &HealthHeader,
        error: &[u8],
        report: &mut Report,
    ) -> Result<(), TransportError> {
        let now_ns = self.newest.map_or_else(wall_ns, |newest| {
            let since_ns = monotonic_ns().saturating_sub(newest.entered_ns).max(0);
            newest.measured_ns.saturating_add(since_ns)
        });
        let error = String::from_utf8_lossy(error);
        let sent = stamp(now_ns).and_then(|now| {
            self.diagnostics
                .send(&ros::diagnostics::of(now, health, &error))
        });
        match sent {
            Ok(()) => report.sent(),
            Err(error) => report.refused(&error)?,
        }
        Ok(())
    }
}
