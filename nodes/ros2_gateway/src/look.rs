//! Lists the topics that the gateway could take, to help with its setup (`--look`).

use std::collections::BTreeSet;
use std::time::{Duration, Instant};

use command_line::stdout;
use serde::Serialize;
use transport::{Flow, Graph, TransportError};
use zenoh_session::Report;

use crate::middleware::Rmw;
use crate::rmw::{self, Member, Seen, Watch};
use crate::{Config, GatewayError};

/// Longest time between two looks at the discovered entities.
const TICK: Duration = Duration::from_millis(50);

/// Endpoint of a router that runs on this machine.
const ROUTER: &str = "tcp/127.0.0.1:7447";

/// Message types that the gateway takes: name in the middleware, and kind.
const TYPES: [(&str, &str); 4] = [
    ("sensor_msgs::msg::dds_::LaserScan_", "scan"),
    ("nav_msgs::msg::dds_::OccupancyGrid_", "map"),
    ("nav_msgs::msg::dds_::Odometry_", "odometry"),
    ("tf2_msgs::msg::dds_::TFMessage_", "transforms"),
];

#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord, Serialize)]
pub(crate) struct Published {
    rmw: Rmw,
    domain: u32,
    /// `scan`, `map`, `odometry` or `transforms`.
    kind: &'static str,
    topic: String,
    node: String,
}

/// Searches for `seconds` on each middleware, or on the chosen one, and prints the published topics
/// that the gateway could take, one JSON object per line.
pub(crate) fn look(graph: &Graph, config: &Config, seconds: f64) -> Result<(), GatewayError> {
    let mut report = Report::new(graph.health()?);
    let mut found = BTreeSet::new();
    let all = [Rmw::Dds, Rmw::Zenoh];
    for rmw in all
        .into_iter()
        .filter(|rmw| config.rmw.is_none_or(|chosen| chosen == *rmw))
    {
        let of_rmw = Config {
            rmw: Some(rmw),
            ..config.clone()
        };
        let joined = match rmw::join(graph, &of_rmw, &mut report) {
            // Another process is the router of this machine: connect to it.
            Err(_) if rmw == Rmw::Zenoh && is_alone(config) => {
                let mut called = of_rmw.clone();
                called.network.connect.push(ROUTER.to_owned());
                rmw::join(graph, &called, &mut report)
            }
            joined => joined,
        };
        match joined {
            Ok(Some(member)) => look_at(graph, (&*member, rmw), seconds, &mut found)?,
            Ok(None) => return Ok(()),
            // The robot may use the other middleware.
            Err(error) => tracing::warn!("{}", transport::with_causes(&error)),
        }
    }
    let lines = found
        .iter()
        .map(|found| command_line::json::object(found) + "\n");
    Ok(stdout::print(&lines.collect::<String>())?)
}

/// True if no Zenoh configuration, listening endpoint or router is given.
fn is_alone(config: &Config) -> bool {
    let network = &config.network;
    network.config.is_none() && network.listen.is_empty() && network.connect.is_empty()
}

fn look_at(
    graph: &Graph,
    (member, rmw): (&Member, Rmw),
    seconds: f64,
    found: &mut BTreeSet<Published>,
) -> Result<(), GatewayError> {
    let mut watch = Watch::open(member, "")?;
    watch.expected.is_everything = true;
    let end = Instant::now() + Duration::from_secs_f64(seconds);
    graph.run(&[], TICK, |_| {
        member.tick();
        while let Some(seen) = watch.next() {
            let Seen::Publisher { node, topic, kind } = seen else {
                continue;
            };
            let Some(&(_, kind)) = TYPES.iter().find(|(name, _)| *name == kind) else {
                continue;
            };
            found.insert(Published {
                rmw,
                domain: member.domain(),
                kind,
                topic,
                node,
            });
        }
        let is_over = Instant::now() >= end;
        Ok::<_, TransportError>(if is_over { Flow::Stop } else { Flow::Continue })
    })?;
    Ok(())
}
