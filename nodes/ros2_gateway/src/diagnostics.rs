//! Diagnostics of the graph's nodes, for the robot.

use messages::{HealthHeader, Stamp};
use ros::DiagnosticArray;
use transport::{TransportError, monotonic_ns, wall_ns};
use zenoh_session::Report;

use crate::GatewayError;
use crate::rmw::{Keeping, Member, Publisher};
use crate::stamps::stamp;

pub(crate) struct Diagnostics {
    publisher: Publisher<DiagnosticArray>,
    /// Stamp of the newest scan, which relates the robot's clock to the host's.
    newest: Option<Stamp>,
    /// Simulation time, nanoseconds, if it is in use.
    sim_ns: Option<i64>,
}

impl Diagnostics {
    pub(crate) fn open(member: &Member, topic: &str) -> Result<Self, GatewayError> {
        Ok(Diagnostics {
            publisher: Publisher::open(member, topic, Keeping::Reliable, 10)?,
            newest: None,
            sim_ns: None,
        })
    }

    pub(crate) fn on_scan(&mut self, stamp: Stamp) {
        self.newest = Some(stamp);
    }

    /// Takes the simulation time, which is in use from then on.
    pub(crate) fn on_sim_time(&mut self, now_ns: i64) {
        self.sim_ns = Some(now_ns);
    }

    pub(crate) fn health(
        &mut self,
        health: &HealthHeader,
        error: &[u8],
        report: &mut Report,
    ) -> Result<(), TransportError> {
        let error = String::from_utf8_lossy(error);
        let outcome = stamp(self.clock_ns()).and_then(|now| {
            let message = ros::diagnostics::of(now, health, &error);
            self.publisher.send(&message)
        });
        report.outcome(outcome)
    }

    /// Returns the time of the robot's clock: simulation time, else extrapolated from the newest
    /// scan, else the host's.
    fn clock_ns(&self) -> i64 {
        if let Some(sim_ns) = self.sim_ns {
            return sim_ns;
        }
        self.newest.map_or_else(wall_ns, |newest| {
            let since_ns = monotonic_ns().saturating_sub(newest.entered_ns).max(0);
            newest.measured_ns.saturating_add(since_ns)
        })
    }
}
