//! Opens both sides and carries messages between them.

use std::rc::Rc;
use std::time::Duration;

use messages::{Topic, topic};
use network_payload::{Visit, Wire};
use transport::{Flow, Graph, Input};
use zenoh::Session;
use zenoh_session::Report;

use crate::alive::Alive;
use crate::incoming::Incoming;
use crate::outgoing::Outgoing;
use crate::plain::Plain;
use crate::ports::Ports;
use crate::route::Route;
use crate::{BridgeError, Config, json};

/// Longest delay for a late joiner of the graph, a remote subscriber to the image, and the
/// detection of a silent node.
const TICK: Duration = Duration::from_millis(50);

/// Carries messages until the stop flag is set.
///
/// # Errors
/// If the descriptor or Zenoh's configuration cannot be used, the session cannot be opened, or the
/// transport fails. An unreachable network is not an error: the bridge waits for it.
pub fn run(graph: &Graph, config: &Config) -> Result<(), BridgeError> {
    let ports = Ports::read(&config.dataflow, &config.id)?;
    let robot = config.robot();
    tracing::info!(%robot, out = ports.out.join(","), into = ports.into.join(","), "ports");
    let mut report = Report::new(graph.health()?);
    let Some(session) = zenoh_session::open(graph, &config.network, || report.tick())? else {
        return Ok(());
    };
    let mut ways = ways(graph, &session, &robot, &ports, config)?;
    let health_comes_in = ports.into.iter().any(|name| name == topic::Health::NAME);
    let mut alive = Alive::open(graph, &session, &robot, health_comes_in)?;
    let inputs: Vec<_> = ways.iter().filter_map(|way| way.input()).collect();
    let inputs: Vec<&dyn Input> = inputs.iter().map(|input| &**input).collect();
    report.ready()?;
    graph.run(&inputs, TICK, |wake| {
        for way in &mut ways {
            way.step(graph, wake.tick, &mut report)?;
        }
        alive.step()?;
        report.tick()?;
        Ok(Flow::Continue)
    })
}

impl<T: Wire> Route for Outgoing<T> {
    fn input(&self) -> Option<Rc<dyn Input>> {
        self.input()
    }

    fn step(&mut self, graph: &Graph, tick: bool, report: &mut Report) -> Result<(), BridgeError> {
        self.step(graph, tick, report)
    }
}

impl<T: Wire> Route for Incoming<T> {
    fn input(&self) -> Option<Rc<dyn Input>> {
        None
    }

    fn step(&mut self, _: &Graph, _: bool, report: &mut Report) -> Result<(), BridgeError> {
        self.step(report)
    }
}

/// Opens all topics of the ports; `network_payload` knows every topic that a descriptor may name.
fn ways(
    graph: &Graph,
    session: &Session,
    robot: &str,
    ports: &Ports,
    config: &Config,
) -> Result<Vec<Box<dyn Route>>, BridgeError> {
    let sender = getrandom::u64().map_err(BridgeError::Random)?;
    let out = ports.out.iter().filter_map(|name| {
        let rates = &config.rate;
        let open = Outward {
            graph,
            session,
            robot,
            sender,
            rates,
        };
        network_payload::by_name(name, open)
    });
    let memory_limit = config.memory.limit();
    let into = ports.into.iter().filter_map(|name| {
        let open = Inward {
            graph,
            session,
            robot,
            memory_limit,
        };
        network_payload::by_name(name, open)
    });
    let mut ways: Vec<Box<dyn Route>> = out.chain(into).collect::<Result<_, _>>()?;
    let goes_out = |name: &str| ports.out.iter().any(|out| out == name);
    let (ends, rates) = ((graph, session), &config.rate);
    if goes_out(topic::Tracked::NAME) {
        let pose = Plain::<topic::Tracked>::open(ends, robot, rates, json::pose)?;
        ways.push(Box::new(pose));
    }
    if goes_out(topic::Health::NAME) {
        let health = Plain::<topic::Health>::open(ends, robot, rates, json::health)?;
        ways.push(Box::new(health));
    }
    Ok(ways)
}

struct Outward<'a> {
    graph: &'a Graph,
    session: &'a Session,
    robot: &'a str,
    sender: u64,
    rates: &'a [crate::Rate],
}

impl Visit for Outward<'_> {
    type Output = Result<Box<dyn Route>, BridgeError>;

    fn visit<T: Wire>(self) -> Self::Output {
        let Outward {
            graph,
            session,
            robot,
            sender,
            rates,
        } = self;
        let way = Outgoing::<T>::open(graph, session, robot, sender, rates)?;
        Ok(Box::new(way))
    }
}

struct Inward<'a> {
    graph: &'a Graph,
    session: &'a Session,
    robot: &'a str,
    memory_limit: map::MemoryLimit,
}

impl Visit for Inward<'_> {
    type Output = Result<Box<dyn Route>, BridgeError>;

    fn visit<T: Wire>(self) -> Self::Output {
        let way = Incoming::<T>::open(self.graph, self.session, self.robot, self.memory_limit)?;
        Ok(Box::new(way))
    }
}
