//! Joins both sides, and carries messages between them.

use std::time::Duration;

use geometry::Mount;
use messages::topic;
use ros::{Empty, Nothing};
use transport::{Flow, Graph, Subscriber, TransportError};
use zenoh_session::Report;

use crate::amcl;
use crate::broadcast::Sent;
use crate::config::MAP_FRAME;
use crate::frames::Frames;
use crate::incoming::Incoming;
use crate::inputs::{Inputs, Taken};
use crate::outgoing::Outgoing;
use crate::rmw::{Member, Service, Watch};
use crate::role::Role;
use crate::seeding::Seeding;
use crate::topics::Topics;
use crate::verdict::Verdict;
use crate::{Config, GatewayError, look};

/// Longest time between two steps; a late joiner of the graph may wait this long for the map.
const TICK: Duration = Duration::from_millis(50);

/// Carries messages until the stop flag is set.
///
/// # Errors
/// If a name or Zenoh's configuration cannot be used, the session cannot be opened, or the graph
/// fails. A missing robot is no error: the gateway waits for it.
pub fn run(graph: &Graph, config: &Config) -> Result<(), GatewayError> {
    if let Some(seconds) = config.look {
        return look::look(graph, config, seconds);
    }
    match config.amcl.role {
        Role::Seed => seed(graph, config),
        Role::Amcl => amcl::run(graph, config, TICK),
    }
}

/// Runs next to the robot's particle filter and gives it its initial pose.
fn seed(graph: &Graph, config: &Config) -> Result<(), GatewayError> {
    config.amcl.check()?;
    let topics = Topics::of(config)?;
    // Wrong options are reported before anything is opened.
    let (domain, mounts) = (config.domain()?, config.mounts()?);
    let mut report = Report::new(graph.health()?);
    let mut inputs = Inputs::default();
    let Some(member) = Member::join(graph, config, &mut report)? else {
        return Ok(());
    };
    let mut gateway = Gateway::open(graph, member, config, &topics, mounts)?;
    tracing::info!(domain, node = config.node(), "joined the robot's domain");
    let (hypotheses, health) = (graph.subscriber()?, graph.subscriber()?);
    let poses = graph.subscriber()?;
    graph.run(&[&hypotheses, &poses, &health], TICK, |_| {
        gateway.step((&hypotheses, &poses), &health, &topics, &mut report)?;
        let (member, taken) = (&gateway.member, Some(gateway.taken()));
        inputs.look((config, &topics), member, taken, None, &mut report)?;
        report.tick()?;
        Ok(Flow::Continue)
    })
}

struct Gateway {
    watch: Watch,
    service: Service<Empty>,
    incoming: Incoming,
    outgoing: Outgoing,
    /// Opened at the first pose of a tracker.
    verdict: Option<Verdict>,
    frames: Frames,
    seeding: Seeding,
    map_frame: Option<String>,
    // Behind all that is open in the robot's domain, which ends before it.
    member: Member,
}

impl Gateway {
    fn open(
        graph: &Graph,
        member: Member,
        config: &Config,
        topics: &Topics,
        mounts: Vec<Mount>,
    ) -> Result<Self, GatewayError> {
        // Publishers are opened before the watch, so that they exist when a subscriber is seen.
        let sent = Sent::default();
        let outgoing = Outgoing::open(&member, config, topics, sent.clone())?;
        let mut watch = Watch::open(graph, &member, &topics.initial_pose)?;
        Ok(Gateway {
            service: Service::open(graph, &member, &topics.reinitialize)?,
            incoming: Incoming::open(graph, &member, config, topics, (&mut watch, sent))?,
            outgoing,
            verdict: None,
            watch,
            member,
            frames: Frames::new(mounts),
            seeding: Seeding::new(config.seed, config.lost_beyond),
            map_frame: config.map_frame.clone(),
        })
    }

    fn step(
        &mut self,
        (hypotheses, poses): (&Subscriber<topic::Hypotheses>, &Subscriber<topic::Tracked>),
        health: &Subscriber<topic::Health>,
        topics: &Topics,
        report: &mut Report,
    ) -> Result<(), TransportError> {
        let on_belief = |belief| self.seeding.on_belief(belief);
        self.incoming.step(&mut self.frames, on_belief, report)?;
        // Between the scans and their results: a subscriber or a request that came before a scan
        // gets the initial pose from that scan.
        self.look(report)?;
        self.serve(report)?;
        let robots = self.incoming.map_frame.as_deref();
        let map_frame = self.map_frame.as_deref().or(robots).unwrap_or(MAP_FRAME);
        if poses.has_publishers() {
            self.outgoing.expect_tracker();
        }
        while let Some(sample) = hypotheses.receive()? {
            report.received();
            let (answer, seeding) = ((sample.header(), sample.items()), &mut self.seeding);
            let outgoing = &mut self.outgoing;
            let sent = outgoing.answer(answer, map_frame, &self.frames, seeding, report);
            sent.or_else(|error| report.refused(&error))?;
        }
        while let Some(sample) = poses.receive()? {
            report.received();
            let header = sample.header();
            let (outgoing, seeding) = (&mut self.outgoing, &mut self.seeding);
            let sent = outgoing.tracked(header, map_frame, seeding, report);
            sent.or_else(|error| report.refused(&error))?;
            let verdict = match &mut self.verdict {
                Some(verdict) => verdict,
                none => match Verdict::open(&self.member, topics) {
                    Ok(verdict) => none.insert(verdict),
                    Err(error) => {
                        report.refused(&error)?;
                        continue;
                    }
                },
            };
            verdict.send(header, sample.items(), map_frame, report)?;
        }
        while let Some(sample) = health.receive()? {
            let diagnostics = &mut self.outgoing.diagnostics;
            diagnostics.health(sample.header(), sample.items(), report)?;
        }
        Ok(())
    }

    fn taken(&self) -> Taken<'_> {
        Taken {
            incoming: &self.incoming,
            watch: &self.watch,
            clock: None,
        }
    }

    fn look(&mut self, report: &mut Report) -> Result<(), TransportError> {
        self.watch.look(&self.member, report, |node| {
            tracing::info!(node, "subscribes to the initial pose");
            self.seeding.greet();
        })
    }

    fn serve(&mut self, report: &mut Report) -> Result<(), TransportError> {
        let answered = self.service.serve(report, |_| Nothing::default())?;
        if answered > 0 {
            tracing::info!("initial pose requested");
            self.seeding.ask();
        }
        Ok(())
    }
}
