//! Opens both sides and carries messages between them.

use std::time::Duration;

use messages::{Topic, topic};
use network_payload::{Visit, Wire};
use transport::{Flow, Graph, Input};
use zenoh_session::Report;

use crate::alive::Alive;
use crate::incoming::Incoming;
use crate::outgoing::Outgoing;
use crate::plain::Plain;
use crate::ports::Ports;
use crate::route::{Ends, Route};
use crate::{BridgeError, Config, json};

/// Longest delay for a late joiner of the graph, a remote subscriber to the image, and the
/// detection of a silent node.
const TICK: Duration = Duration::from_millis(50);

/// Carries messages until the stop flag is set.
///
/// An unreachable network is not an error: the bridge waits for it.
pub fn run(graph: &Graph, config: &Config) -> Result<(), BridgeError> {
    let ports = Ports::read(&config.dataflow, &config.id)?;
    let robot = &config.robot;
    tracing::info!(%robot, out = ports.out.join(","), into = ports.into.join(","), "ports");
    let mut report = Report::new(graph.health()?);
    let Some(session) = zenoh_session::open(graph, &config.network, || report.tick())? else {
        return Ok(());
    };
    let ends = Ends {
        graph,
        session: &session,
        robot,
        config,
        sender: getrandom::u64().map_err(BridgeError::Random)?,
    };
    let mut ways = ways(ends, &ports)?;
    let health_comes_in = ports.into.iter().any(|name| name == topic::Health::NAME);
    let mut alive = Alive::open(graph, &session, robot, health_comes_in)?;
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

/// Opens all topics of the ports; `network_payload` knows every topic that a descriptor may name.
fn ways(ends: Ends<'_>, ports: &Ports) -> Result<Vec<Box<dyn Route>>, BridgeError> {
    let out = ports.out.iter().map(|name| (name, true));
    let into = ports.into.iter().map(|name| (name, false));
    let opened = out
        .chain(into)
        .filter_map(|(name, goes_out)| network_payload::by_name(name, Opening { ends, goes_out }));
    let mut ways: Vec<Box<dyn Route>> = opened.collect::<Result<_, _>>()?;
    let goes_out = |name: &str| ports.out.iter().any(|out| out == name);
    if goes_out(topic::Tracked::NAME) {
        ways.push(Box::new(Plain::<topic::Tracked>::open(ends, json::pose)?));
    }
    if goes_out(topic::Health::NAME) {
        ways.push(Box::new(Plain::<topic::Health>::open(ends, json::health)?));
    }
    Ok(ways)
}

struct Opening<'a> {
    ends: Ends<'a>,
    goes_out: bool,
}

impl Visit for Opening<'_> {
    type Output = Result<Box<dyn Route>, BridgeError>;

    fn visit<T: Wire>(self) -> Self::Output {
        Ok(match self.goes_out {
            true => Box::new(Outgoing::<T>::open(self.ends)?),
            false => Box::new(Incoming::<T>::open(self.ends)?),
        })
    }
}
