//! Joins both sides, and carries messages between them.

use std::time::Duration;

use geometry::Mount;
use ros::{Empty, Nothing};
use transport::{Flow, Graph, TransportError};
use zenoh_session::Report;

use crate::amcl;
use crate::broadcast::Sent;
use crate::config::MAP_FRAME;
use crate::frames::Frames;
use crate::incoming::Incoming;
use crate::inputs::{Inputs, Taken};
use crate::joined::{Joined, Results};
use crate::outgoing::Outgoing;
use crate::rmw::{self, Service, Watch};
use crate::role::Role;
use crate::seeding::Seeding;
use crate::topics::Topics;
use crate::verdict::Verdict;
use crate::{Config, GatewayError, look};

/// Longest time between two steps; a late joiner of the graph may wait this long for the map.
const TICK: Duration = Duration::from_millis(50);

/// Carries messages until the stop flag is set. A missing robot is no error: the gateway waits for it.
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
    let Some(member) = rmw::join(graph, config, &mut report)? else {
        return Ok(());
    };
    let joined = Joined {
        graph,
        member: &*member,
        config,
        topics: &topics,
    };
    let mut gateway = Gateway::open(joined, mounts)?;
    tracing::info!(domain, node = config.node(), "joined the robot's domain");
    let results = Results::open(graph)?;
    graph.run(&results.all(), TICK, |_| {
        gateway.step(&results, &mut report)?;
        let taken = Taken {
            incoming: &gateway.incoming,
            watch: &gateway.watch,
            clock: None,
        };
        inputs.look(joined, Some(taken), None, &mut report)?;
        report.tick()?;
        Ok(Flow::Continue)
    })
}

struct Gateway<'a> {
    joined: Joined<'a>,
    watch: Watch,
    service: Service<Empty>,
    incoming: Incoming,
    outgoing: Outgoing,
    /// Opened at the first pose of a tracker.
    verdict: Option<Verdict>,
    frames: Frames,
    seeding: Seeding,
}

impl<'a> Gateway<'a> {
    fn open(joined: Joined<'a>, mounts: Vec<Mount>) -> Result<Self, GatewayError> {
        let (member, config, topics) = (joined.member, joined.config, joined.topics);
        // Publishers are opened before the watch, so that they exist when a subscriber is seen.
        let sent = Sent::default();
        let outgoing = Outgoing::open(joined, sent.clone())?;
        let mut watch = Watch::open(member, &topics.initial_pose)?;
        Ok(Gateway {
            service: Service::open(member, &topics.reinitialize)?,
            incoming: Incoming::open(joined, &mut watch, sent)?,
            outgoing,
            verdict: None,
            watch,
            joined,
            frames: Frames::new(mounts, None),
            seeding: Seeding::new(config.seed, config.lost_beyond),
        })
    }

    fn step(&mut self, results: &Results, report: &mut Report) -> Result<(), TransportError> {
        let on_belief = |belief| self.seeding.on_belief(belief);
        self.incoming.step(&mut self.frames, on_belief, report)?;
        // Between the scans and their results: a subscriber or a request that came before a scan
        // gets the initial pose from that scan.
        self.watch.look(report, |node| {
            tracing::info!(node, "subscribes to the initial pose");
            self.seeding.greet();
        })?;
        if self.service.serve(report, |_| Nothing::default())? > 0 {
            tracing::info!("initial pose requested");
            self.seeding.ask();
        }
        let users = self.joined.config.map_frame.as_deref();
        let robots = self.incoming.map_frame.as_deref();
        let map_frame = users.or(robots).unwrap_or(MAP_FRAME);
        if results.poses.has_publishers() {
            self.outgoing.expect_tracker();
        }
        let (outgoing, seeding) = (&mut self.outgoing, &mut self.seeding);
        while let Some(sample) = results.hypotheses.receive()? {
            report.received();
            let answer = (sample.header(), sample.items());
            let sent = outgoing.answer(answer, map_frame, &self.frames, seeding, report);
            sent.or_else(|error| report.refused(&error))?;
        }
        while let Some(sample) = results.poses.receive()? {
            report.received();
            let header = sample.header();
            let sent = outgoing.tracked(header, map_frame, seeding, report);
            sent.or_else(|error| report.refused(&error))?;
            let verdict = match &mut self.verdict {
                Some(verdict) => verdict,
                none => match Verdict::open(self.joined.member, self.joined.topics) {
                    Ok(verdict) => none.insert(verdict),
                    Err(error) => {
                        report.refused(&error)?;
                        continue;
                    }
                },
            };
            verdict.send(header, sample.items(), map_frame, report)?;
        }
        while let Some(sample) = results.health.receive()? {
            let diagnostics = &mut outgoing.diagnostics;
            diagnostics.health(sample.header(), sample.items(), report)?;
        }
        Ok(())
    }
}
