//! Bond with the lifecycle manager: heartbeats while the node is active, which end when it is not.

use ros::{BondStatus, Header, Time};
use transport::{monotonic_ns, wall_ns};
use twox_hash::XxHash3_128;

use crate::GatewayError;
use crate::rmw::{Member, Publisher};

/// Time without a heartbeat after which the manager gives the node up, seconds; the same as in
/// nav2.
const TIMEOUT_S: f32 = 4.0;

pub(super) struct Bond {
    publisher: Publisher<BondStatus>,
    /// Name of the node, without its namespace.
    id: String,
    instance_id: String,
    period_ns: i64,
    sent_ns: Option<i64>,
}

impl Bond {
    /// Opens the bond of a node; `period_s` is above 0.
    pub(super) fn open(
        member: &Member,
        topic: &str,
        node: &str,
        period_s: f64,
    ) -> Result<Self, GatewayError> {
        // No other bond of this process begins at this nanosecond.
        let seed = format!("{} {} {}", wall_ns(), monotonic_ns(), std::process::id());
        Ok(Bond {
            publisher: Publisher::open_blocking(member, topic, 10)?,
            id: node.to_owned(),
            instance_id: format!("{:032x}", XxHash3_128::oneshot(seed.as_bytes())),
            period_ns: (period_s * 1e9) as i64,
            sent_ns: None,
        })
    }

    pub(super) fn tick(&mut self) -> Result<(), GatewayError> {
        let now_ns = monotonic_ns();
        let is_due = |sent_ns| now_ns - sent_ns >= self.period_ns;
        match self.sent_ns.is_none_or(is_due) {
            true => self.send(true),
            false => Ok(()),
        }
    }

    pub(super) fn end(mut self) -> Result<(), GatewayError> {
        self.send(false)
    }

    fn send(&mut self, active: bool) -> Result<(), GatewayError> {
        self.sent_ns = Some(monotonic_ns());
        self.publisher.send(&BondStatus {
            header: Header::new(Time::from_ns(wall_ns()).unwrap_or_default(), ""),
            id: self.id.clone(),
            instance_id: self.instance_id.clone(),
            active,
            heartbeat_timeout: TIMEOUT_S,
            heartbeat_period: self.period_ns as f32 * 1e-9,
        })
    }
}
