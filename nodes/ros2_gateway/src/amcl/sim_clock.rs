//! Simulation time, from topic `/clock`.

use ros::Clock;
use transport::{Graph, TransportError};
use zenoh_session::Report;

use crate::GatewayError;
use crate::checks::measured_ns;
use crate::incoming::{MAX_BYTES, take};
use crate::rmw::{Keeping, Member, Subscription, Watch};
use crate::topics::Topics;

pub(super) struct SimClock {
    clocks: Subscription<Clock>,
    /// Nanoseconds since 1970; `None` before the first message.
    pub(super) now_ns: Option<i64>,
    pub(super) received: u64,
}

impl SimClock {
    pub(super) fn open(
        graph: &Graph,
        member: &Member,
        topics: &Topics,
        watch: &mut Watch,
    ) -> Result<Self, GatewayError> {
        watch.expected.expect::<Clock>(&topics.clock)?;
        Ok(SimClock {
            clocks: Subscription::open(graph, member, &topics.clock, Keeping::Fresh, 1, MAX_BYTES)?,
            now_ns: None,
            received: 0,
        })
    }

    pub(super) fn take(&mut self, report: &mut Report) -> Result<(), TransportError> {
        take(&mut self.clocks, report, |message, _| {
            self.now_ns = Some(measured_ns("the clock", message.clock)?);
            self.received += 1;
            Ok(())
        })
    }
}
