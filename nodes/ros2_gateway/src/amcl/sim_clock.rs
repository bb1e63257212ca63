//! Simulation time, from topic `/clock`.

use ros::Clock;
use transport::TransportError;
use zenoh_session::Report;

use crate::GatewayError;
use crate::checks::measured_ns;
use crate::incoming::MAX_BYTES;
use crate::rmw::{Keeping, Member, Subscription, Watch, take};

pub(super) struct SimClock {
    clocks: Subscription<Clock>,
    /// Nanoseconds since 1970; `None` before the first message.
    pub(super) now_ns: Option<i64>,
    pub(super) received: u64,
}

impl SimClock {
    pub(super) fn open(
        member: &Member,
        topic: &str,
        watch: &mut Watch,
    ) -> Result<Self, GatewayError> {
        watch.expected.expect::<Clock>(topic)?;
        Ok(SimClock {
            clocks: Subscription::open(member, topic, Keeping::Fresh, 1, MAX_BYTES)?,
            now_ns: None,
            received: 0,
        })
    }

    pub(super) fn take(&mut self, report: &mut Report) -> Result<(), TransportError> {
        take(Some(&mut self.clocks), report, |message, _| {
            self.now_ns = Some(measured_ns("the clock", message.clock)?);
            self.received += 1;
            Ok(())
        })
    }
}
