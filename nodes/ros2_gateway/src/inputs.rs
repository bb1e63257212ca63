//! Supervision of the robot's inputs: a change is logged, and the current state is in the node's
//! health.

use transport::{TransportError, monotonic_ns};
use zenoh_session::Report;

use crate::config::{Brought, Config};
use crate::incoming::Incoming;
use crate::joined::Joined;
use crate::rmw::Watch;
use crate::role::Role;
use crate::topics::Topics;
use crate::waiting::{Input, Status, Waiting};

/// Time between two looks, nanoseconds.
const PERIOD_NS: i64 = 200_000_000;

#[derive(Default)]
pub(crate) struct Inputs {
    waiting: Waiting,
    /// Time of the last look; `None` before the first.
    looked_ns: Option<i64>,
    said: Option<String>,
}

pub(crate) struct Taken<'a> {
    pub(crate) incoming: &'a Incoming,
    pub(crate) watch: &'a Watch,
    /// Number of clock messages received; `None` if no clock is needed.
    pub(crate) clock: Option<u64>,
}

impl Inputs {
    /// Reports what is missing: the router, else an input, else `itself`, the reason for which the
    /// gateway itself waits. `taken` is `None` while no input is open.
    pub(crate) fn look(
        &mut self,
        joined: Joined<'_>,
        taken: Option<Taken<'_>>,
        itself: Option<&str>,
        report: &mut Report,
    ) -> Result<(), TransportError> {
        let now_ns = monotonic_ns();
        let is_early = |looked_ns| now_ns.saturating_sub(looked_ns) < PERIOD_NS;
        if self.looked_ns.is_some_and(is_early) {
            return Ok(());
        }
        let is_first = self.looked_ns.replace(now_ns).is_none();
        joined.member.tick();
        let inputs = taken.map(|taken| taken.inputs(joined.config, joined.topics));
        let missing = joined.member.missing();
        let status = match &inputs {
            _ if !missing.is_empty() => Status::Waits(&missing),
            None => itself.map_or(Status::Begins, Status::Waits),
            Some(inputs) => match (self.waiting.look(inputs, now_ns), itself) {
                (Status::Flows, Some(itself)) => Status::Waits(itself),
                (status, _) => status,
            },
        };
        let words = match status {
            Status::Flows => None,
            Status::Begins => Some(""),
            Status::Waits(words) => Some(words),
        };
        report.waiting_for(words)?;
        if is_first || self.said.as_deref() != words {
            match words {
                None => tracing::info!("all that the robot brings comes"),
                Some("") => {}
                Some(words) => tracing::warn!("waiting for {words}"),
            }
            self.said = words.map(str::to_owned);
        }
        Ok(())
    }
}

impl Taken<'_> {
    /// Lists the inputs to wait for, without topics that `--bring` leaves out.
    fn inputs<'t>(&self, config: &'t Config, topics: &'t Topics) -> Vec<Input<'t>> {
        let (maps, scans) = self.incoming.outlet.sent();
        let input = |topic: &'t str, received, comes_once| Input {
            topic,
            publishing: self.watch.expected.publishing(topic),
            received,
            comes_once,
            from_frame: None,
        };
        // In the seed role, a robot may be without odometry.
        let needs_odometry = config.amcl.role == Role::Amcl && config.brings(Brought::Odometry);
        let odometry = needs_odometry.then(|| Input {
            from_frame: Some(config.odom_frame()),
            ..input(&topics.tf, self.incoming.outlet.odometry_sent, false)
        });
        let map = config
            .brings(Brought::Map)
            .then(|| input(&topics.map, maps, true));
        let scans = topics
            .scans
            .iter()
            .zip(scans)
            .filter(|_| config.brings(Brought::Scan))
            .map(|(scans, received)| input(&scans.topic, received, false));
        let clock = self
            .clock
            .map(|received| input(&topics.clock, received, false));
        let others = odometry.into_iter().chain(clock);
        map.into_iter().chain(scans).chain(others).collect()
    }
}
