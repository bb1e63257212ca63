//! Quality of service, as rosbag2 stores it with each channel.

/// The longest duration, which means "no limit" in ROS 2.
const NO_LIMIT: &str = "sec: 9223372036\n    nsec: 854775807";

pub(crate) const KEY: &str = "offered_qos_profiles";

/// Value of that key: one profile, reliable, with history "keep last"; transient local if the topic
/// is latched, else volatile. The numbers are those of `rmw_qos_profile_t`.
pub(crate) fn offered(latched: bool) -> String {
    let (depth, durability) = if latched { (1, 1) } else { (10, 2) };
    format!(
        "- history: 1\n  depth: {depth}\n  reliability: 1\n  durability: {durability}\n  \
         deadline:\n    {NO_LIMIT}\n  lifespan:\n    {NO_LIMIT}\n  liveliness: 1\n  \
         liveliness_lease_duration:\n    {NO_LIMIT}\n  avoid_ros_namespace_conventions: false"
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn latched_topics_are_transient_local() {
        assert!(offered(true).contains("\n  depth: 1\n  reliability: 1\n  durability: 1\n"));
        assert!(offered(false).contains("\n  durability: 2\n  deadline:\n    sec: 9223372036\n"));
    }
}
