//! Inputs and outputs of the node while it is configured.

use messages::{InitialPose, InitialPoseKind};
use ros::{Empty, Nothing};
use transport::{TransportError, monotonic_ns};
use zenoh_session::Report;

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
use crate::joined::{Joined, Results};
use crate::outlet::Rules;
use crate::rmw::{Service, Watch};

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
        let (member, topics) = (joined.member, joined.topics);
        let uses_sim_time = parameters.is_on("use_sim_time");
        let sent = Sent::default();
        let outgoing = Outgoing::open(joined, uses_sim_time, sent.clone())?;
        let mut watch = Watch::open(member, &topics.initial_pose)?;
        let mut incoming = Incoming::open(joined, &mut watch, sent)?;
        incoming.outlet.rules = rules(parameters);
        let hints = Hints::open(joined, &mut watch)?;
        let clock = uses_sim_time.then(|| SimClock::open(member, &topics.clock, &mut watch));
        let base = parameters.text("base_frame_id").to_owned();
        Ok(Parts {
            nomotion: Service::open(member, &topics.nomotion)?,
            frames: Frames::new(joined.config.mounts()?, Some(base)),
            saved: SavedPose::default(),
            offered: None,
            clock: clock.transpose()?,
            hints,
            outgoing,
            watch,
            incoming,
        })
    }

    /// Handles the robot's messages; an initial pose among them goes to `pending`.
    pub(super) fn take(
        &mut self,
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
        self.watch.look(report, |_| {})?;
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
        results: &Results,
        map_frame: &str,
        parameters: &Parameters,
        pending: &mut Option<InitialPose>,
        report: &mut Report,
    ) -> Result<(), TransportError> {
        if let Some(kind) = self.hints.hand_on(pending)? {
            self.offered = None;
            match kind {
                InitialPoseKind::Anywhere => {
                    self.outgoing.start_over();
                    self.saved.forget();
                }
                InitialPoseKind::Hint | InitialPoseKind::Believed => self.outgoing.go_on(),
            }
        }
        let outgoing = &mut self.outgoing;
        while let Some(sample) = results.poses.receive()? {
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
        while let Some(sample) = results.hypotheses.receive()? {
            report.received();
            outgoing.found(sample.header(), sample.items(), map_frame, report)?;
        }
        while let Some(sample) = results.health.receive()? {
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
