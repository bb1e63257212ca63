//! Discovery settings from the environment variables of ROS.

use std::net::{IpAddr, Ipv4Addr};

use rustdds::DomainParticipantBuilder;

/// Range in which other nodes are discovered.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Range {
    /// In all networks of this machine, by multicast.
    Subnet,
    /// On this machine.
    Localhost,
    /// Nowhere.
    Off,
}

/// Returns a participant's settings, from `ROS_AUTOMATIC_DISCOVERY_RANGE` and `ROS_LOCALHOST_ONLY`;
/// the latter takes precedence.
pub(super) fn builder(domain: u16) -> DomainParticipantBuilder {
    let variable = |name| std::env::var(name).unwrap_or_default();
    let range = range(
        &variable("ROS_LOCALHOST_ONLY"),
        &variable("ROS_AUTOMATIC_DISCOVERY_RANGE"),
    );
    if !variable("ROS_STATIC_PEERS").is_empty() {
        tracing::warn!("ROS_STATIC_PEERS is ignored: other machines are found by multicast alone");
    }
    let builder = DomainParticipantBuilder::new(domain);
    let localhost = [IpAddr::V4(Ipv4Addr::LOCALHOST)];
    match range {
        Range::Subnet => builder,
        Range::Localhost => builder.with_only_networks(localhost),
        Range::Off => builder
            .with_only_networks(localhost)
            .same_host_loopback(false),
    }
}

fn range(localhost_only: &str, automatic: &str) -> Range {
    match (localhost_only, automatic) {
        ("1", _) | (_, "LOCALHOST") => Range::Localhost,
        (_, "OFF") => Range::Off,
        (_, "" | "SUBNET" | "SYSTEM_DEFAULT") => Range::Subnet,
        (_, other) => {
            tracing::warn!(
                "ROS_AUTOMATIC_DISCOVERY_RANGE is {other:?}: allowed are SUBNET, LOCALHOST, OFF \
                 and SYSTEM_DEFAULT; SUBNET is taken"
            );
            Range::Subnet
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_older_variable_counts_before_the_newer_one() {
        assert_eq!(range("1", "SUBNET"), Range::Localhost);
        assert_eq!(range("0", "OFF"), Range::Off);
        assert_eq!(range("", "LOCALHOST"), Range::Localhost);
        assert_eq!(range("", ""), Range::Subnet);
        assert_eq!(range("", "subnet"), Range::Subnet);
    }
}
