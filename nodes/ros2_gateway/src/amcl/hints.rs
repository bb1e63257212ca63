//! Initial poses from a topic or a service, and their way to the tracker.

use messages::{InitialPose, InitialPoseKind, topic};
use ros::nav2_msgs::SetInitialPose;
use ros::{Empty, Nothing, PoseWithCovarianceStamped};
use transport::{Publisher, TransportError, monotonic_ns};
use zenoh_session::Report;

use super::hint;
use crate::GatewayError;
use crate::frames::Frames;
use crate::incoming::MAX_BYTES;
use crate::joined::Joined;
use crate::rmw::{Keeping, Service, Subscription, Watch, take};

pub(super) struct Hints {
    initial_poses: Subscription<PoseWithCovarianceStamped>,
    set_initial_pose: Service<SetInitialPose>,
    reinitialize: Service<Empty>,
    publisher: Publisher<topic::InitialPoseTopic>,
    sent: u64,
    kind: InitialPoseKind,
}

impl Hints {
    pub(super) fn open(joined: Joined<'_>, watch: &mut Watch) -> Result<Self, GatewayError> {
        let (member, topics) = (joined.member, joined.topics);
        let topic = &topics.initial_pose;
        watch.expected.expect::<PoseWithCovarianceStamped>(topic)?;
        let reliable = Keeping::Reliable;
        Ok(Hints {
            initial_poses: Subscription::open(member, topic, reliable, 10, MAX_BYTES)?,
            set_initial_pose: Service::open(member, &topics.set_initial_pose)?,
            reinitialize: Service::open(member, &topics.reinitialize)?,
            publisher: joined.graph.publisher()?,
            sent: 0,
            kind: joined.config.amcl.kind(),
        })
    }

    /// Takes the queued poses and requests; the newest stays in `pending` until it can be handed
    /// on.
    pub(super) fn take(
        &mut self,
        frames: &Frames,
        map_frame: &str,
        pending: &mut Option<InitialPose>,
        report: &mut Report,
    ) -> Result<(), TransportError> {
        let kind = self.kind;
        let said = |message: &PoseWithCovarianceStamped| -> Result<InitialPose, GatewayError> {
            let pose = hint::of_message(kind, message, map_frame, |ns| frames.moved_since(ns))?;
            let how = match kind {
                InitialPoseKind::Believed => "it is believed",
                _ => "it is tried first, and a scan must confirm it",
            };
            tracing::info!("an initial pose came: {how}");
            Ok(pose)
        };
        take(Some(&mut self.initial_poses), report, |message, _| {
            *pending = Some(said(&message)?);
            Ok(())
        })?;
        let mut wrong = Vec::new();
        self.set_initial_pose.serve(report, |request| {
            match said(&request.pose) {
                Ok(found) => *pending = Some(found),
                // The response has no field for it.
                Err(error) => wrong.push(error),
            }
            Nothing::default()
        })?;
        for error in wrong {
            report.refused(&error)?;
        }
        self.reinitialize.serve(report, |_| {
            tracing::info!("asked to localize from anywhere: the tracker forgets its pose");
            *pending = Some(hint::anywhere());
            Nothing::default()
        })?;
        Ok(())
    }

    /// Sends the pending pose once there is a tracker; returns its kind.
    pub(super) fn hand_on(
        &mut self,
        pending: &mut Option<InitialPose>,
    ) -> Result<Option<InitialPoseKind>, TransportError> {
        if !self.publisher.has_subscribers() {
            return Ok(None);
        }
        let Some(mut said) = pending.take() else {
            return Ok(None);
        };
        said.stamp.entered_ns = monotonic_ns();
        said.stamp.counter = self.sent;
        self.publisher.send(said, &[])?;
        self.sent += 1;
        Ok(InitialPoseKind::from_code(said.kind))
    }
}
