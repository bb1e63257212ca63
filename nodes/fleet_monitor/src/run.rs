//! Subscribes on the network and feeds the server.

use std::time::Duration;

use dashboard::{Robots, Server};
use messages::topic;
use transport::{Flow, Graph};
use zenoh::Session;
use zenoh_session::Report;

use crate::feed::{ALL, Feed};
use crate::fleet::{Fleet, Shown, Taken};
use crate::requests::Requests;
use crate::{Config, FleetError};

/// Longest delay for a request, an image and the detection of a silent node.
const TICK: Duration = Duration::from_millis(50);

/// Serves the page until the stop flag is set.
///
/// # Errors
/// If the page cannot be served, the token or Zenoh's configuration cannot be used, or the
/// transport of this machine fails. An unreachable network is not an error: the node waits for it.
pub fn run(graph: &Graph, config: &Config) -> Result<(), FleetError> {
    let robots = Robots::default();
    let server = Server::start(config.page, &config.dashboard, robots.clone())?;
    server.announce("watch all robots", config.page);
    let mut report = Report::new(graph.health()?);
    let Some(session) = zenoh_session::open(graph, &config.network, || report.tick())? else {
        return Ok(());
    };
    let mut node = Node {
        inputs: Inputs::open(graph, &session)?,
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

/// Topics with a permanent subscription.
struct Inputs {
    maps: Feed<topic::Map>,
    hypotheses: Feed<topic::Hypotheses>,
    poses: Feed<topic::Tracked>,
    beams: Feed<topic::Beams>,
    health: Feed<topic::Health>,
    log: Feed<topic::Log>,
}

struct Node {
    session: Session,
    inputs: Inputs,
    fleet: Fleet,
    /// Session id by which robots recognize this process.
    sender: u64,
    report: Report,
}

impl Inputs {
    fn open(graph: &Graph, session: &Session) -> Result<Self, FleetError> {
        Ok(Inputs {
            maps: Feed::open(session, ALL, graph.waker()?)?,
            hypotheses: Feed::open(session, ALL, graph.waker()?)?,
            poses: Feed::open(session, ALL, graph.waker()?)?,
            beams: Feed::open(session, ALL, graph.waker()?)?,
            health: Feed::open(session, ALL, graph.waker()?)?,
            log: Feed::open(session, ALL, graph.waker()?)?,
        })
    }
}

impl Node {
    /// Processes everything that has arrived, maps before the results that refer to them.
    fn step(&mut self, graph: &Graph, tick: bool) -> Result<(), FleetError> {
        let Node {
            session,
            inputs,
            fleet,
            sender,
            report,
        } = self;
        let mut intake = Intake {
            session,
            fleet,
            sender: *sender,
            report,
        };
        intake.take(&inputs.maps)?;
        intake.take(&inputs.hypotheses)?;
        intake.take(&inputs.poses)?;
        intake.take(&inputs.beams)?;
        intake.take(&inputs.health)?;
        intake.take(&inputs.log)?;
        intake.take_fields()?;
        if tick {
            for granted in fleet.tick(graph, session)? {
                report.outcome(granted)?;
            }
        }
        report.tick().map_err(FleetError::from)
    }
}

struct Intake<'a> {
    session: &'a Session,
    fleet: &'a mut Fleet,
    sender: u64,
    report: &'a mut Report,
}

impl Intake<'_> {
    fn take<T: Shown>(&mut self, feed: &Feed<T>) -> Result<(), FleetError> {
        self.report.dropped(feed.dropped());
        let (session, sender) = (self.session, self.sender);
        let join = |robot: &str| Requests::open(session, robot, sender);
        for message in feed.waiting() {
            let message = message.map_err(FleetError::from);
            let outcome = message.and_then(|message| self.fleet.take(&message, join));
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
