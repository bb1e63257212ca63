//! Names of a robot's lasers: in the graph by name, in ROS by the topic of their scans.

/// Topic of a laser's scans; the only laser has an empty name.
pub fn topic_of(laser: &str) -> String {
    match laser {
        "" => "/scan".to_owned(),
        laser => format!("/{laser}/scan"),
    }
}

/// Name of a laser by the topic of its scans: `front` for `/front/scan`, `/scan_front` and
/// `/front_scan`, and `scan` if nothing else is left.
pub fn name_of(topic: &str) -> String {
    let parts = topic.split('/').filter(|part| !part.is_empty());
    let parts: Vec<&str> = parts.filter(|part| *part != "scan").collect();
    let joined = parts.join("_");
    let name = joined.strip_prefix("scan_").unwrap_or(&joined);
    let name = name.strip_suffix("_scan").unwrap_or(name);
    match name {
        "" => "scan".to_owned(),
        name => name.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_laser_is_called_by_what_its_topic_says_beside_scan() {
        for (topic, expected) in [
            ("/front/scan", "front"),
            ("/scan_rear", "rear"),
            ("/rear_scan", "rear"),
            ("/robot1/laser_left/scan", "robot1_laser_left"),
            ("/scan", "scan"),
            ("lidar", "lidar"),
        ] {
            assert_eq!(name_of(topic), expected, "{topic}");
        }
        assert_eq!(name_of(&topic_of("front")), "front");
        assert_eq!(topic_of(""), "/scan");
    }
}
