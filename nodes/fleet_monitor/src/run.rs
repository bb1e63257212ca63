//! Subscribes on the network and feeds the server.

use std::time::Duration;

use dashboard::{Robots, Server};
use messages::topic;
use network_payload::Wire;
use transport::{Flow, Graph, TransportError, monotonic_ns};
use zenoh::Session;
use zenoh_session::Report;

use crate::feed::{ALL, Feed};
use crate::fleet::{Fleet, Show, Taken, sound};
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
    let inputs = inputs(graph, &session)?;
    let sender = getrandom::u64().map_err(FleetError::Random)?;
    let mut fleet = Fleet::new(robots, session, sender);
    report.ready()?;
    graph.run(&[], TICK, |wake| {
        server.check()?;
        for input in &inputs {
            input.take(&mut fleet, &mut report)?;
        }
        for outcome in fleet.take_fields() {
            note(outcome, &mut report)?;
        }
        if wake.tick {
            for granted in fleet.tick(graph)? {
                report.outcome(granted)?;
            }
        }
        report.tick()?;
        Ok(Flow::Continue)
    })
}

/// A topic with a permanent subscription.
trait Input {
    fn take(&self, fleet: &mut Fleet, report: &mut Report) -> Result<(), TransportError>;
}

impl<T: Wire> Input for (Feed<T>, Show<T>) {
    fn take(&self, fleet: &mut Fleet, report: &mut Report) -> Result<(), TransportError> {
        let (feed, show) = self;
        report.dropped(feed.dropped());
        for message in feed.waiting() {
            let message = message.map_err(FleetError::from);
            note(
                message.and_then(|message| fleet.take(&message, *show)),
                report,
            )?;
        }
        Ok(())
    }
}

fn note(outcome: Result<Taken, FleetError>, report: &mut Report) -> Result<(), TransportError> {
    report.received();
    match outcome {
        Ok(Taken::Shown { lost }) => report.dropped(lost),
        Ok(Taken::Repeated) => {}
        Err(error) => report.refused(&error)?,
    }
    Ok(())
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
