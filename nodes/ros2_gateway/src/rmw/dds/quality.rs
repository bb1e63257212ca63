//! The quality of service of a topic, as policies of DDS.

use rustdds::policy::{Durability, History, Reliability, ResourceLimits};
use rustdds::{Duration, QosPolicies, QosPolicyBuilder};

use crate::rmw::Keeping;

/// Time that a message that must arrive waits for a slow network.
const MAX_BLOCKING: Duration = Duration::from_millis(100);

pub(super) fn offered(keeping: Keeping, depth: usize, blocks: bool) -> QosPolicies {
    let wait = match blocks {
        true => MAX_BLOCKING,
        false => Duration::ZERO,
    };
    common(keeping, depth, wait).build()
}

/// Returns the policies of a topic that is subscribed to; `rustdds` keeps at most `depth` messages
/// of all senders together.
pub(super) fn requested(keeping: Keeping, depth: usize) -> QosPolicies {
    let depth_i32 = i32::try_from(depth).unwrap_or(i32::MAX);
    common(keeping, depth, MAX_BLOCKING)
        .resource_limits(ResourceLimits {
            max_samples: depth_i32,
            max_instances: 1,
            max_samples_per_instance: depth_i32,
        })
        .build()
}

fn common(keeping: Keeping, depth: usize, wait: Duration) -> QosPolicyBuilder {
    let (durability, reliability) = match keeping {
        Keeping::Fresh => (Durability::Volatile, Reliability::BestEffort),
        Keeping::Reliable => (Durability::Volatile, reliable(wait)),
        Keeping::Kept => (Durability::TransientLocal, reliable(wait)),
    };
    QosPolicyBuilder::new()
        .durability(durability)
        .reliability(reliability)
        .history(History::KeepLast {
            depth: i32::try_from(depth).unwrap_or(i32::MAX),
        })
}

fn reliable(max_blocking_time: Duration) -> Reliability {
    Reliability::Reliable { max_blocking_time }
}

pub(super) fn in_words(quality: &QosPolicies) -> String {
    let reliability = match quality.is_reliable() {
        true => "reliable",
        false => "best effort",
    };
    let durability = match quality.is_volatile() {
        true => "volatile",
        false => "transient local",
    };
    format!("{reliability}, {durability}")
}
