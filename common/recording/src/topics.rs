//! Selects the channel to use for a kind of message: by type, and by conventional name only if
//! several channels have the type.

use std::path::Path;

use crate::{Channel, Kind, RecordingError, TF_STATIC};

/// Conventional topic of scans.
pub const SCAN: &str = "/scan";
/// Conventional topic of the map.
pub const MAP: &str = "/map";
/// Conventional topic of odometry.
pub const ODOM: &str = "/odom";
/// Topic of the true poses of the scans: always this name, because any other pose has the same
/// type.
pub const GROUND_TRUTH: &str = "/ground_truth";

fn conventional_name(kind: Kind) -> &'static str {
    match kind {
        Kind::Scan => SCAN,
        Kind::Map => MAP,
        Kind::Odometry => ODOM,
        Kind::PoseStamped => GROUND_TRUTH,
        Kind::StaticTransforms => TF_STATIC,
    }
}

/// Command-line option that selects a channel of a kind.
pub(crate) fn option(kind: Kind) -> &'static str {
    match kind {
        Kind::Scan => "--scan-topic",
        Kind::Map => "--map-topic",
        Kind::Odometry => "--odom-topic",
        Kind::PoseStamped | Kind::StaticTransforms => "--remap",
    }
}

/// Selects the channel with messages of a kind; `None` if there is none.
pub(crate) fn choose<'a>(
    channels: &[&'a Channel],
    kind: Kind,
    path: &Path,
) -> Result<Option<&'a Channel>, RecordingError> {
    let has_messages = |channel: &&&Channel| channel.kind == Some(kind) && channel.messages > 0;
    let mut of_kind: Vec<&Channel> = channels.iter().filter(has_messages).copied().collect();
    // A merged recording may define a topic twice.
    of_kind.sort_by(|a, b| a.topic.cmp(&b.topic));
    of_kind.dedup_by(|a, b| a.topic == b.topic);
    let name = conventional_name(kind);
    let named = of_kind.iter().find(|channel| &*channel.topic == name);
    match (&of_kind[..], named) {
        (_, Some(named)) => Ok(Some(named)),
        (_, None) if kind == Kind::PoseStamped => Ok(None),
        ([], _) => Ok(None),
        ([only], _) => Ok(Some(only)),
        (several, None) => Err(RecordingError::SeveralTopics {
            path: path.to_owned(),
            kind,
            name,
            found: several.iter().map(|c| c.topic.to_string()).collect(),
        }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn channel(topic: &str, kind: Kind, messages: u64) -> Channel {
        Channel {
            topic: topic.into(),
            schema: kind.schema().to_owned(),
            encoding: "cdr".to_owned(),
            kind: Some(kind),
            messages,
        }
    }

    fn chosen(kind: Kind, topics: &[(&str, u64)]) -> Result<Option<String>, String> {
        let channels: Vec<Channel> = topics
            .iter()
            .map(|&(topic, messages)| channel(topic, kind, messages))
            .collect();
        let channels: Vec<&Channel> = channels.iter().collect();
        choose(&channels, kind, Path::new("r.mcap"))
            .map(|channel| channel.map(|channel| channel.topic.to_string()))
            .map_err(|error| error.to_string())
    }

    #[test]
    fn the_type_decides_and_the_name_among_several() {
        assert_eq!(chosen(Kind::Scan, &[]), Ok(None));
        let only = chosen(Kind::Scan, &[("/lidar/front", 3)]);
        assert_eq!(only, Ok(Some("/lidar/front".to_owned())));
        let named = chosen(Kind::Scan, &[("/a", 1), ("/scan", 1), ("/b", 1)]);
        assert_eq!(named, Ok(Some("/scan".to_owned())));
        let empty = chosen(Kind::Scan, &[("/scan", 0), ("/b", 1)]);
        assert_eq!(empty, Ok(Some("/b".to_owned())));
        let twice = chosen(Kind::Scan, &[("/b", 1), ("/b", 1)]);
        assert_eq!(twice, Ok(Some("/b".to_owned())));
        assert_eq!(
            chosen(Kind::Scan, &[("/a", 1), ("/b", 1)]).unwrap_err(),
            "r.mcap has several channels of sensor_msgs/msg/LaserScan, /a, /b, \
             and none is called /scan: name one with --scan-topic"
        );
    }

    #[test]
    fn a_goal_is_not_taken_for_the_truth() {
        assert_eq!(chosen(Kind::PoseStamped, &[("/goal_pose", 1)]), Ok(None));
        let truth = chosen(Kind::PoseStamped, &[("/goal_pose", 1), (GROUND_TRUTH, 1)]);
        assert_eq!(truth, Ok(Some(GROUND_TRUTH.to_owned())));
    }
}
