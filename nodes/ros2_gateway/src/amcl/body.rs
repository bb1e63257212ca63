//! What the node has while it is configured: what it takes, what it offers and what it
//! publishes.

use messages::{InitialPose, topic};
use ros::nav2_msgs::SetInitialPose;
use ros::{Empty, Nothing, PoseWithCovarianceStamped};
use transport::{Graph, Publisher as GraphPublisher, Subscriber, TransportError, monotonic_ns};
use zenoh_session::Report;

use super::bond::Bond;
use super::hint;
use super::lifecycle::Change;
use super::outgoing::Outgoing;
use super::parameters::Parameters;
use super::waiting::{Input, Waiting};
use crate::config::Brought;
use crate::frames::Frames;
use crate::incoming::{Incoming, MAX_BYTES, take};
use crate::outlet::Rules;
use crate::rmw_zenoh::{Keeping, Member, Seen, Service, Subscription, Watch};
use crate::seeding::Seeding;
use crate::topics::Topics;
use crate::{Config, GatewayError};

/// What the graph says.
pub(super) struct Said {
    pub(super) hypotheses: Subscriber<topic::Hypotheses>,
    pub(super) poses: Subscriber<topic::Tracked>,
    pub(super) health: Subscriber<topic::Health>,
}

/// The node but for its life.
pub(super) struct Body<'a> {
    pub(super) graph: &'a Graph,
    pub(super) member: &'a Member,
    pub(super) config: &'a Config,
    pub(super) topics: &'a Topics,
    pub(super) map_frame: String,
    parts: Option<Parts>,
    bond: Option<Bond>,
    /// Where somebody says that the robot is; kept until it can be handed on.
    hint: Option<InitialPose>,
    is_active: bool,
    was_active: bool,
}

struct Parts {
    watch: Watch,
    incoming: Incoming,
    initial_poses: Subscription<PoseWithCovarianceStamped>,
    set_initial_pose: Service<SetInitialPose>,
    reinitialize: Service<Empty>,
    nomotion: Service<Empty>,
    outgoing: Outgoing,
    hints: GraphPublisher<topic::InitialPoseTopic>,
    hints_sent: u64,
    frames: Frames,
    waiting: Waiting,
    /// Never asked: nobody else's filter is seeded.
    seeding: Seeding,
}

impl<'a> Body<'a> {
    pub(super) fn new(
        graph: &'a Graph,
        member: &'a Member,
        config: &'a Config,
        topics: &'a Topics,
        map_frame: String,
    ) -> Self {
        Body {
            graph,
            member,
            config,
            topics,
            map_frame,
            parts: None,
            bond: None,
            hint: None,
            is_active: false,
            was_active: false,
        }
    }

    /// Does what the lifecycle manager wants; whether it could.
    pub(super) fn change(&mut self, change: Change, parameters: &Parameters) -> bool {
        let outcome = match change {
            Change::Configure => self.configure(parameters),
            Change::Activate => self.activate(parameters),
            Change::Deactivate => self.deactivate(),
            Change::Cleanup => {
                self.parts = None;
                Ok(())
            }
            Change::Shutdown => {
                let ended = self.deactivate();
                self.parts = None;
                ended
            }
        };
        if let Err(error) = &outcome {
            tracing::error!("{change:?} failed: {}", transport::with_causes(error));
        }
        outcome.is_ok() || change == Change::Shutdown
    }

    fn configure(&mut self, parameters: &Parameters) -> Result<(), GatewayError> {
        let Body {
            graph,
            member,
            config,
            topics,
            ..
        } = *self;
        let outgoing = Outgoing::open(member, topics)?;
        let mut watch = Watch::open(graph, member, &topics.initial_pose)?;
        let mut incoming = Incoming::open(graph, member, config, topics, &mut watch)?;
        incoming.set_rules(rules(parameters));
        watch.expect::<PoseWithCovarianceStamped>(&topics.initial_pose)?;
        let initial_poses = Subscription::open(
            graph,
            member,
            &topics.initial_pose,
            Keeping::Reliable,
            10,
            MAX_BYTES,
        )?;
        let base = parameters.text("base_frame_id").to_owned();
        self.parts = Some(Parts {
            set_initial_pose: Service::open(graph, member, &topics.set_initial_pose)?,
            reinitialize: Service::open(graph, member, &topics.reinitialize)?,
            nomotion: Service::open(graph, member, &topics.nomotion)?,
            hints: graph.publisher()?,
            hints_sent: 0,
            frames: Frames::new(config.mounts()?).with_base(base),
            seeding: Seeding::new(config.seed, config.lost_beyond),
            waiting: Waiting::default(),
            outgoing,
            watch,
            incoming,
            initial_poses,
        });
        Ok(())
    }

    fn activate(&mut self, parameters: &Parameters) -> Result<(), GatewayError> {
        let period_s = parameters.number("bond_heartbeat_period");
        if period_s > 0.0 {
            let bond = Bond::open(self.member, &self.topics.bond, self.config.node(), period_s)?;
            self.bond = Some(bond);
        }
        let is_first = !std::mem::replace(&mut self.was_active, true);
        let is_again = is_first || parameters.is_on("always_reset_initial_pose");
        if parameters.is_on("set_initial_pose") && is_again && self.hint.is_none() {
            self.hint = Some(hint::of_parameters(parameters.initial_pose()));
        }
        self.is_active = true;
        Ok(())
    }

    fn deactivate(&mut self) -> Result<(), GatewayError> {
        self.is_active = false;
        if let Some(parts) = &mut self.parts {
            parts.outgoing.rest();
        }
        self.bond.take().map_or(Ok(()), Bond::end)
    }

    /// Takes and sends what there is.
    pub(super) fn step(
        &mut self,
        said: &Said,
        parameters: &Parameters,
        report: &mut Report,
    ) -> Result<(), TransportError> {
        let Some(parts) = &mut self.parts else {
            return drain(said);
        };
        parts.incoming.set_rules(rules(parameters));
        parts
            .incoming
            .step(&mut parts.frames, &mut parts.seeding, report)?;
        parts.look(self.member, report)?;
        parts.wait(self.config, self.topics);
        parts.take_hints(&self.map_frame, &mut self.hint, report)?;
        parts.serve(&self.map_frame, &mut self.hint, report)?;
        if self.is_active {
            parts.hand_on(&mut self.hint)?;
            parts.send(said, &self.map_frame, parameters, report)?;
        } else {
            drain(said)?;
        }
        if let Some(bond) = &mut self.bond
            && let Err(error) = bond.tick()
        {
            report.refused(&error)?;
        }
        Ok(())
    }
}

/// Passes over what is sent to nobody.
fn drain(said: &Said) -> Result<(), TransportError> {
    while said.hypotheses.receive()?.is_some() {}
    while said.poses.receive()?.is_some() {}
    while said.health.receive()?.is_some() {}
    Ok(())
}

impl Parts {
    /// Who publishes something else than is taken.
    fn look(&mut self, member: &Member, report: &mut Report) -> Result<(), TransportError> {
        report.dropped(self.watch.dropped());
        while let Some(seen) = self.watch.next(member) {
            if let Seen::Stranger(error) = seen {
                report.refused(&error)?;
            }
        }
        Ok(())
    }

    /// Says which of the inputs do not come.
    fn wait(&mut self, config: &Config, topics: &Topics) {
        let (maps, scans) = self.incoming.sent();
        let input = |topic, received| Input {
            topic,
            has_publisher: self.watch.has_found(topic),
            received,
        };
        // What the robot does not bring is not waited for.
        let maps = if config.brings(Brought::Map) { maps } else { 1 };
        let scans: Vec<Input<'_>> = topics
            .scans
            .iter()
            .zip(scans)
            .filter(|_| config.brings(Brought::Scan))
            .map(|(scans, received)| input(&scans.topic, received))
            .collect();
        match self
            .waiting
            .look(&input(&topics.map, maps), &scans, monotonic_ns())
        {
            Some("") => tracing::info!("map and scans come"),
            Some(words) => tracing::warn!("waiting for {words}"),
            None => {}
        }
    }

    /// Where somebody says that the robot is, by topic.
    fn take_hints(
        &mut self,
        map_frame: &str,
        hint: &mut Option<InitialPose>,
        report: &mut Report,
    ) -> Result<(), TransportError> {
        let frames = &self.frames;
        take(&mut self.initial_poses, report, |message, _| {
            *hint = Some(hint::of_message(&message, map_frame, |ns| {
                frames.moved_since(ns)
            })?);
            tracing::info!("an initial pose came: it is tried first, and a scan must confirm it");
            Ok(())
        })
    }

    fn serve(
        &mut self,
        map_frame: &str,
        hint: &mut Option<InitialPose>,
        report: &mut Report,
    ) -> Result<(), TransportError> {
        let frames = &self.frames;
        let mut wrong = Vec::new();
        self.set_initial_pose.serve(report, |request| {
            match hint::of_message(&request.pose, map_frame, |ns| frames.moved_since(ns)) {
                Ok(found) => *hint = Some(found),
                // The response has no room for it.
                Err(error) => wrong.push(error),
            }
            Nothing::default()
        })?;
        for error in wrong {
            report.refused(&error)?;
        }
        // Each scan is an update, also while the robot stands.
        self.nomotion.serve(report, |_| Nothing::default())?;
        self.reinitialize.serve(report, |_| {
            tracing::info!(
                "asked to localize from anywhere: the tracker searches by itself whenever scans \
                 speak against its pose, and keeps the pose while they fit"
            );
            *hint = None;
            Nothing::default()
        })?;
        Ok(())
    }

    /// Gives the tracker what somebody says, once it is there.
    fn hand_on(&mut self, hint: &mut Option<InitialPose>) -> Result<(), TransportError> {
        if !self.hints.has_subscribers() {
            return Ok(());
        }
        let Some(mut said) = hint.take() else {
            return Ok(());
        };
        said.stamp.entered_ns = monotonic_ns();
        said.stamp.counter = self.hints_sent;
        let mut loan = self.hints.loan(0)?;
        *loan.header_mut() = said;
        loan.send()?;
        self.hints_sent += 1;
        Ok(())
    }

    fn send(
        &mut self,
        said: &Said,
        map_frame: &str,
        parameters: &Parameters,
        report: &mut Report,
    ) -> Result<(), TransportError> {
        let outgoing = &mut self.outgoing;
        while let Some(sample) = said.poses.receive()? {
            report.received();
            outgoing.tracked(sample.header(), map_frame, report)?;
            // Each scan has its transform, also where several are answered at once.
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
        outgoing.tick(map_frame, parameters, report)
    }
}

/// What is done to scans and maps.
fn rules(parameters: &Parameters) -> Rules {
    let limit = |name: &str| Some(parameters.number(name) as f32).filter(|limit| *limit > 0.0);
    Rules {
        range_min_m: limit("laser_min_range"),
        range_max_m: limit("laser_max_range"),
        first_map_only: parameters.is_on("first_map_only"),
    }
}
