//! Inputs and outputs of the node while it is configured.

use messages::{InitialPose, InitialPoseKind};
use ros::{Empty, Nothing};
use transport::{TransportError, monotonic_ns};
use zenoh_session::Report;

use super::{Joined, Said};
use crate::GatewayError;
use crate::amcl::hints::Hints;
use crate::amcl::outgoing::Outgoing;
use crate::amcl::parameters::Parameters;
use crate::amcl::saved_pose::{self, SavedPose};
use crate::amcl::sim_clock::SimClock;
use crate::broadcast::Sent;
use crate::frames::Frames;
use crate::incoming::Incoming;
use crate::inputs::Taken;
use crate::outlet::Rules;
use crate::rmw::{Member, Service, Watch};

/// Inputs and outputs that exist from configuration to cleanup.
pub(super) struct Parts {
    watch: Watch,
    incoming: Incoming,
    clock: Option<SimClock>,
    hints: Hints,
    nomotion: Service<Empty>,
    outgoing: Outgoing,
    frames: Frames,
    saved: SavedPose,
    /// Saved pose of the last run, for a tracker without a pose: one that believes a pose would
    /// forget it. Kept until the tracker's first pose.
    pub(super) offered: Option<InitialPose>,
}

impl Parts {
    pub(super) fn open(joined: Joined<'_>, parameters: &Parameters) -> Result<Self, GatewayError> {
        let Joined {
            graph,
            member,
            config,
            topics,
        } = joined;
        let uses_sim_time = parameters.is_on("use_sim_time");
        let sent = Sent::default();
        let outgoing = Outgoing::open(member, topics, uses_sim_time, sent.clone())?;
        let mut watch = Watch::open(graph, member, &topics.initial_pose)?;
        let mut incoming = Incoming::open(graph, member, config, topics, (&mut watch, sent))?;
        incoming.outlet.rules = rules(parameters);
        let are_believed = config.amcl.believe_initial_pose;
        let hints = Hints::open(graph, member, topics, &mut watch, are_believed)?;
        let clock = match uses_sim_time {
            true => Some(SimClock::open(graph, member, topics, &mut watch)?),
            false => None,
        };
        let base = parameters.text("base_frame_id").to_owned();
        Ok(Parts {
            nomotion: Service::open(graph, member, &topics.nomotion)?,
            frames: Frames::new(config.mounts()?).with_base(base),
            saved: SavedPose::default(),
            offered: None,
            clock,
            hints,
            outgoing,
            watch,
            incoming,
        })
    }

    /// Handles the robot's messages; an initial pose among them goes to `pending`.
    pub(super) fn take(
        &mut self,
        member: &Member,
        parameters: &Parameters,
        map_frame: &str,
        pending: &mut Option<InitialPose>,
        report: &mut Report,
    ) -> Result<(), TransportError> {
        if let Some(clock) = &mut self.clock {
            clock.take(report)?;
            if let Some(now_ns) = clock.now_ns {
                self.outgoing.on_sim_time(now_ns);
            }
        }
        self.incoming.outlet.rules = rules(parameters);
        // No particle filter is seeded.
        self.incoming.step(&mut self.frames, |_| {}, report)?;
        self.watch.look(member, report, |_| {})?;
        self.hints.take(&self.frames, map_frame, pending, report)?;
        // Each scan is an update anyway, even while the robot stands still.
        self.nomotion.serve(report, |_| Nothing::default())?;
        Ok(())
    }

    pub(super) fn taken(&self) -> Taken<'_> {
        Taken {
            incoming: &self.incoming,
            watch: &self.watch,
            clock: self.clock.as_ref().map(|clock| clock.received),
        }
    }

    /// Hands on the pending pose and sends the graph's results to the robot, while the node is
    /// active.
    pub(super) fn send(
        &mut self,
        said: &Said,
        map_frame: &str,
        parameters: &Parameters,
        pending: &mut Option<InitialPose>,
        report: &mut Report,
    ) -> Result<(), TransportError> {
        let handed_on = self.hints.hand_on(pending)?;
        if handed_on.is_some() {
            self.offered = None;
        }
        match handed_on {
            None => {}
            Some(InitialPoseKind::Anywhere) => {
                self.outgoing.start_over();
                self.saved.forget();
            }
            Some(InitialPoseKind::Hint | InitialPoseKind::Believed) => self.outgoing.go_on(),
        }
        let outgoing = &mut self.outgoing;
        while let Some(sample) = said.poses.receive()? {
            report.received();
            let header = sample.header();
            outgoing.tracked((header, sample.items()), map_frame, report)?;
            if header.from_scan == 1 {
                self.saved.take(header);
                let offered = self.offered.take().filter(|_| !header.is_believed());
                *pending = pending.take().or(offered);
            }
            // Each scan gets its transform, even if several results arrive at once.
            outgoing.tick(map_frame, parameters, report)?;
        }
        while let Some(sample) = said.hypotheses.receive()? {
            report.received();
            outgoing.found(sample.header(), sample.items(), map_frame, report)?;
        }
        while let Some(sample) = said.health.receive()? {
            let diagnostics = &mut outgoing.diagnostics;
            diagnostics.health(sample.header(), sample.items(), report)?;
        }
        outgoing.tick(map_frame, parameters, report)?;
        let due = self
            .saved
            .due(parameters.number("save_pose_rate"), monotonic_ns());
        match due.map_or(Ok(()), |pose| save(parameters, map_frame, pose)) {
            Ok(()) => Ok(()),
            Err(error) => report.refused(&error),
        }
    }

    /// Ends the active state: forgets what would be sent again, and saves the last pose.
    pub(super) fn rest(&mut self, parameters: &Parameters, map_frame: &str) {
        self.outgoing.rest();
        let left = self.saved.left(parameters.number("save_pose_rate"));
        if let Some(pose) = left
            && let Err(error) = save(parameters, map_frame, pose)
        {
            tracing::warn!("{error}");
        }
    }
}

fn save(
    parameters: &Parameters,
    map_frame: &str,
    pose: (geometry::Pose, i64),
) -> Result<(), GatewayError> {
    match parameters.saved_pose_file() {
        None => Ok(()),
        Some(file) => saved_pose::save(file, map_frame, pose),
    }
}

fn rules(parameters: &Parameters) -> Rules {
    let limit = |name: &str| Some(parameters.number(name) as f32).filter(|limit| *limit > 0.0);
    Rules {
        range_min_m: limit("laser_min_range"),
        range_max_m: limit("laser_max_range"),
        first_map_only: parameters.is_on("first_map_only"),
    }
}
