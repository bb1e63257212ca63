//! Subscribes on the network and feeds the server.

use std::time::Duration;

use dashboard::{Robots, Server};
use messages::topic;
use network_payload::Wire;
use transport::{Flow, Graph, monotonic_ns};
use zenoh::Session;
use zenoh_session::Report;

use crate::feed::{ALL, Feed};
use crate::fleet::{Fleet, Show, Taken, sound};
use crate::requests::Requests;
use crate::{Config, FleetError};

/// Longest delay for a request, an image and the detection of a silent node.
const TICK: Duration = Duration::from_millis(50);

/// Serves the page until the stop flag is set.
///
/// An unreachable network is not an error: the node waits for it.
pub fn run(graph: &Graph, config: &Config) -> Result<(), FleetError> {
    let robots = Robots::default();
    let server = Server::start(config.page, &config.dashboard, robots.clone())?;
    server.announce("watch all robots", config.page);
    let mut report = Report::new(graph.health()?);
    let Some(session) = zenoh_session::open(graph, &config.network, || report.tick())? else {
        return Ok(());
    };
    let mut node = Node {
        inputs: inputs(graph, &session)?,
        fleet: Fleet::new(robots),
        sender: getrandom::u64().map_err(FleetError::Random)?,
        session,
        report,
    };
    node.report.ready()?;
    graph.run(&[], TICK, |wake| {
        server.check()?;
        node.step(graph, wake.tick)?;
        Ok(Flow::Continue)
    })
}

struct Node {
    session: Session,
    inputs: Vec<Box<dyn Input>>,
    fleet: Fleet,
    /// Session id by which robots recognize this process.
    sender: u64,
    report: Report,
}

/// A topic with a permanent subscription.
trait Input {
    fn take(&self, intake: &mut Intake<'_>) -> Result<(), FleetError>;
}

impl<T: Wire> Input for (Feed<T>, Show<T>) {
    fn take(&self, intake: &mut Intake<'_>) -> Result<(), FleetError> {
        intake.take(&self.0, self.1)
    }
}

/// Subscribes to all topics, maps before the results that refer to them.
fn inputs(graph: &Graph, session: &Session) -> Result<Vec<Box<dyn Input>>, FleetError> {
    fn input<T: Wire>(
        (graph, session): (&Graph, &Session),
        show: Show<T>,
    ) -> Result<Box<dyn Input>, FleetError> {
        let feed = Feed::<T>::open(session, ALL, graph.waker()?)?;
        Ok(Box::new((feed, show)))
    }
    let ends = (graph, session);
    Ok(vec![
        input::<topic::Map>(ends, |robot, header, cells| {
            sound(
                robot.on_map(header, cells),
                "the map contradicts its header",
            )
        })?,
        input::<topic::Hypotheses>(ends, |robot, header, items| {
            robot.on_answer(header, items, monotonic_ns());
            Ok(())
        })?,
        input::<topic::Tracked>(ends, |robot, header, words| {
            robot.on_pose(header, words, monotonic_ns());
            Ok(())
        })?,
        input::<topic::Beams>(ends, |robot, header, beams| {
            robot.on_beams(header, beams);
            Ok(())
        })?,
        input::<topic::Health>(ends, |robot, report, error| {
            let problem = "a report of more nodes than are shown";
            sound(robot.on_health(report, error), problem)
        })?,
        input::<topic::Log>(ends, |robot, header, line| {
            robot.on_log(header, line);
            Ok(())
        })?,
    ])
}

impl Node {
    /// Processes everything that has arrived.
    fn step(&mut self, graph: &Graph, tick: bool) -> Result<(), FleetError> {
        let mut intake = Intake {
            session: &self.session,
            fleet: &mut self.fleet,
            sender: self.sender,
            report: &mut self.report,
        };
        for input in &self.inputs {
            input.take(&mut intake)?;
        }
        intake.take_fields()?;
        if tick {
            for granted in self.fleet.tick(graph, &self.session)? {
                self.report.outcome(granted)?;
            }
        }
        self.report.tick().map_err(FleetError::from)
    }
}

struct Intake<'a> {
    session: &'a Session,
    fleet: &'a mut Fleet,
    sender: u64,
    report: &'a mut Report,
}

impl Intake<'_> {
    fn take<T: Wire>(&mut self, feed: &Feed<T>, show: Show<T>) -> Result<(), FleetError> {
        self.report.dropped(feed.dropped());
        let (session, sender) = (self.session, self.sender);
        let join = |robot: &str| Requests::open(session, robot, sender);
        for message in feed.waiting() {
            let message = message.map_err(FleetError::from);
            let outcome = message.and_then(|message| self.fleet.take(&message, show, join));
            self.note(outcome)?;
        }
        Ok(())
    }

    fn take_fields(&mut self) -> Result<(), FleetError> {
        let mut outcomes = self.fleet.take_fields().into_iter();
        outcomes.try_for_each(|outcome| self.note(outcome))
    }

    fn note(&mut self, outcome: Result<Taken, FleetError>) -> Result<(), FleetError> {
        self.report.received();
        match outcome {
            Ok(Taken::Shown { lost }) => self.report.dropped(lost),
            Ok(Taken::Repeated) => {}
            Err(error) => self.report.refused(&error)?,
        }
        Ok(())
    }
}
